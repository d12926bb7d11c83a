#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tread::scene
{

/// Removes leading characters contained in `letters`; returns whether there were any.
bool take(std::string_view& text, std::string_view letters);

/// Prepares a user's text for a message: truncates it to `most` bytes and replaces control characters by question
/// marks.
std::string shown(std::string_view text, std::size_t most = 80);

} // namespace tread::scene
