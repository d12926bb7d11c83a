#pragma once

namespace tread
{

/// Of the code, as in CMakeLists.txt (tests/cli/commands.py compares them).
inline constexpr const char* version = "0.1.0";

} // namespace tread
