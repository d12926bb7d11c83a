#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tread::scene
{

/// Takes what is made of these letters off a text's front; whether there was any.
bool take(std::string_view& text, std::string_view letters);

/// A user's text for a message: what is over `most` bytes is left out, control characters become question marks.
std::string shown(std::string_view text, std::size_t most = 80);

} // namespace tread::scene
