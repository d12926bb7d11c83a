#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tread::scene
{

/// White space.
inline constexpr std::string_view blanks = " \t\n\v\f\r";

/// Removes leading characters contained in `letters`; returns whether there were any.
bool take(std::string_view& text, std::string_view letters);

/// Returns the text without blanks at its ends.
std::string_view trimmed(std::string_view text);

/// Prepares a user's text for a message: truncates it to `most` bytes and replaces control characters by question
/// marks.
std::string shown(std::string_view text, std::size_t most = 80);

} // namespace tread::scene
