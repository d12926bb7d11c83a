#pragma once

#include <optional>
#include <string>

namespace tread
{

/// Why a path is not a regular file; empty if it is one. Opening a pipe or a device could block, so the path is not
/// opened; links are followed.
std::optional<std::string> irregularity(const std::string& path);

/// EnvironmentError, with that reason, unless a path is a regular file.
void require_regular(const std::string& path);

} // namespace tread
