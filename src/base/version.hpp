#pragma once

namespace tread
{

/// Version of the code, as in CMakeLists.txt (tests/cli/commands.py compares them).
inline constexpr const char* version = "0.2.0";

/// Commit that was built, with "-dirty" appended if files had changed; "unknown" outside a repository.
const char* commit();

} // namespace tread
