#pragma once

namespace tread
{

/// Of the code, as in CMakeLists.txt (tests/cli/commands.py compares them).
inline constexpr const char* version = "0.2.0";

/// The commit that was built, "-dirty" behind it if files had changed; "unknown" outside a repository.
const char* commit();

} // namespace tread
