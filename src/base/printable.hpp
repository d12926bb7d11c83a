#pragma once

#include <string>
#include <string_view>

namespace tread
{

/// Text for a terminal: control characters other than line breaks and tabs, and bytes that are no UTF-8, stand as
/// "\x1b", so that no title or name from a file commands the terminal. UTF-8 stays, but for its own control
/// characters (U+0080 to U+009F).
std::string printable(std::string_view text);

} // namespace tread
