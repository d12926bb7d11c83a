#pragma once

#include <optional>
#include <string>

namespace tread
{

/// Why a path is not a regular file (a pipe or a device would be waited for), or nothing if it is one. Looks at what a
/// link leads to; does not open it.
std::optional<std::string> irregularity(const std::string& path);

/// EnvironmentError, with that reason, unless a path is a regular file.
void require_regular(const std::string& path);

} // namespace tread
