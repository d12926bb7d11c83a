#include "base/printable.hpp"

#include <cstddef>

#include <fmt/format.h>

namespace tread
{

std::string printable(std::string_view text)
{
    constexpr unsigned char before_c1 = 0xc2; // first byte of U+0080 to U+00BF
    std::string             made;
    for (std::size_t i = 0; i < text.size(); ++i)
    {
        const auto byte = static_cast<unsigned char>(text[i]);
        const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : 0);
        if (byte == before_c1 && next >= 0x80 && next < 0xa0)
        {
            made += fmt::format("\\u{:04x}", next);
            ++i;
        }
        else if ((byte < 0x20 && byte != '\n' && byte != '\t') || byte == 0x7f)
        {
            made += fmt::format("\\x{:02x}", byte);
        }
        else { made += text[i]; }
    }
    return made;
}

} // namespace tread
