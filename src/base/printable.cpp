#include "base/printable.hpp"

#include <cstddef>

#include <fmt/format.h>

namespace tread
{
namespace
{

/// Bytes of the first character of a text; 0 if it is not UTF-8, or is an ASCII control character other than a line
/// break or a tab.
std::size_t plain_bytes(std::string_view text)
{
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    if (byte(0) < 0x80) { return byte(0) >= 0x20 ? byte(0) != 0x7f : byte(0) == '\n' || byte(0) == '\t'; }
    const std::size_t bytes = byte(0) < 0xc2 ? 0 : byte(0) < 0xe0 ? 2 : byte(0) < 0xf0 ? 3 : byte(0) < 0xf5 ? 4 : 0;
    if (bytes == 0 || text.size() < bytes) { return 0; }
    for (std::size_t i = 1; i < bytes; ++i)
    {
        if ((byte(i) & 0xc0) != 0x80) { return 0; }
    }
    const bool beyond = (byte(0) == 0xe0 && byte(1) < 0xa0) || (byte(0) == 0xed && byte(1) > 0x9f) ||
                        (byte(0) == 0xf0 && byte(1) < 0x90) || (byte(0) == 0xf4 && byte(1) > 0x8f);
    return beyond ? 0 : bytes;
}

bool is_c1_control(std::string_view character)
{
    return character.size() == 2 && static_cast<unsigned char>(character[0]) == 0xc2 &&
           static_cast<unsigned char>(character[1]) < 0xa0;
}

} // namespace

std::string printable(std::string_view text)
{
    std::string made;
    while (!text.empty())
    {
        const std::size_t      bytes     = plain_bytes(text);
        const std::string_view character = text.substr(0, bytes > 0 ? bytes : 1);
        const auto             last      = static_cast<unsigned char>(character.back());
        if (bytes == 0) { made += fmt::format("\\x{:02x}", last); }
        else if (is_c1_control(character)) { made += fmt::format("\\u{:04x}", last); }
        else { made += character; }
        text.remove_prefix(character.size());
    }
    return made;
}

} // namespace tread
