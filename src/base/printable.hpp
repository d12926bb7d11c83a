#pragma once

#include <string>
#include <string_view>

namespace tread
{

/// Escapes text for a terminal: control characters other than line breaks and tabs, and bytes that are not UTF-8,
/// become "\x1b", so that no title or name from a file controls the terminal. UTF-8 is kept except its own control
/// characters (U+0080 to U+009F).
std::string printable(std::string_view text);

} // namespace tread
