#include "base/version.hpp"

#include "commit_text.hpp"

namespace tread
{

const char* commit() { return TREAD_COMMIT; }

} // namespace tread
