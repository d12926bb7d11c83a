#include "scene/text.hpp"

#include <algorithm>

namespace tread::scene
{

bool take(std::string_view& text, std::string_view letters)
{
    const std::size_t end = std::min(text.find_first_not_of(letters), text.size());
    text.remove_prefix(end);
    return end > 0;
}

std::string_view trimmed(std::string_view text)
{
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) { return {}; }
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string shown(std::string_view text, std::size_t most)
{
    const auto  is_inside = [](char letter) { return (static_cast<unsigned char>(letter) & 0xc0) == 0x80; }; // UTF-8
    std::size_t end       = std::min(text.size(), most);
    while (end > 0 && end < text.size() && is_inside(text[end])) { --end; }
    std::string result(text.substr(0, end));
    for (char& letter : result)
    {
        if (static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f) { letter = '?'; }
    }
    return end < text.size() ? result + "..." : result;
}

} // namespace tread::scene
