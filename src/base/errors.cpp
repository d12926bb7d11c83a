#include "base/errors.hpp"

#include <new>
#include <system_error>

#include "base/printable.hpp"

namespace tread
{

ExitCode code_of(const std::exception& error)
{
    if (const auto* known = dynamic_cast<const Error*>(&error)) { return known->code(); }
    const bool machine = dynamic_cast<const std::bad_alloc*>(&error) != nullptr ||
                         dynamic_cast<const std::system_error*>(&error) != nullptr;
    return machine ? ExitCode::environment : ExitCode::numerical;
}

std::string text_of(const std::exception& error)
{
    return dynamic_cast<const std::bad_alloc*>(&error) == nullptr
               ? printable(error.what())
               : "out of host memory while the scene was built or written: fewer points or rocks, a coarser grid, or a "
                 "machine with more memory";
}

} // namespace tread
