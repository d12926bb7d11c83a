#pragma once

#include <cstdint>
#include <string>

namespace tread
{

/// "12.3 MB": for people; decimal units.
std::string bytes_text(std::int64_t bytes);

} // namespace tread
