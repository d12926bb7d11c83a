#pragma once

#include <cstdint>
#include <string>

namespace tread
{

/// Formats bytes for people, as "12.3 MB"; decimal units.
std::string bytes_text(std::int64_t bytes);

} // namespace tread
