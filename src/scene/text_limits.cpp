#include "scene/text_limits.hpp"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

namespace tread::scene
{
namespace
{

std::optional<Excess> long_line(std::string_view text)
{
    std::size_t number = 1;
    for (std::size_t from = 0; from < text.size(); ++number)
    {
        const std::size_t end = std::min(text.find('\n', from), text.size());
        if (end - from > most_line)
        {
            return Excess{number, fmt::format("a line of {} bytes", end - from),
                          fmt::format("at most {} bytes a line", most_line)};
        }
        from = end + 1;
    }
    return std::nullopt;
}

/// Length of the character of UTF-8 at a place (Unicode 15.0, table 3-7); 0 if there is none.
std::size_t length_of_character(std::string_view text, std::size_t at)
{
    const auto byte = [&](std::size_t i)
    { return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0U; };
    const auto is   = [&](std::size_t i, unsigned low, unsigned high) { return byte(i) >= low && byte(i) <= high; };
    const auto rest = [&](std::size_t i) { return is(i, 0x80, 0xbf); };
    if (is(0, 0x00, 0x7f)) { return 1; }
    if (is(0, 0xc2, 0xdf)) { return rest(1) ? 2 : 0; }
    if (is(0, 0xe0, 0xef))
    {
        const bool second = is(1, byte(0) == 0xe0 ? 0xa0 : 0x80, byte(0) == 0xed ? 0x9f : 0xbf);
        return second && rest(2) ? 3 : 0;
    }
    if (is(0, 0xf0, 0xf4))
    {
        const bool second = is(1, byte(0) == 0xf0 ? 0x90 : 0x80, byte(0) == 0xf4 ? 0x8f : 0xbf);
        return second && rest(2) && rest(3) ? 4 : 0;
    }
    return 0;
}

std::optional<Excess> foreign_byte(std::string_view text)
{
    for (std::size_t at = 0; at < text.size();)
    {
        const std::size_t length = length_of_character(text, at);
        if (length == 0)
        {
            const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
            return Excess{static_cast<std::size_t>(line),
                          fmt::format("the byte {:#04x}, which is not UTF-8", static_cast<unsigned char>(text[at])),
                          "a text in UTF-8"};
        }
        at += length;
    }
    return std::nullopt;
}

/// Scans a text outside strings and comments, counting levels of brackets and segments of keys.
class Scan
{
public:
    explicit Scan(std::string_view text)
        : text_(text)
    {
    }

    std::optional<Excess> run()
    {
        while (at_ < text_.size())
        {
            step();
            if (depth_ > most_depth) { return excess("values nested", depth_, most_depth, "deep"); }
            if (dots_ >= most_segments) { return excess("a key of", dots_ + 1, most_segments, "segments"); }
        }
        return std::nullopt;
    }

private:
    void step()
    {
        const char letter = text_[at_];
        if (letter == '"' || letter == '\'')
        {
            skip_string(letter);
            return;
        }
        if (letter == '#')
        {
            at_ = std::min(text_.find('\n', at_), text_.size());
            return;
        }
        ++at_;
        if (letter == '.') { ++dots_; }
        if (std::string_view("=,[]{}\n").find(letter) != std::string_view::npos) { dots_ = 0; }
        if (letter == '\n') { ++line_; }
        if (letter == '[' || letter == '{') { ++depth_; }
        if (letter == ']' || letter == '}') { depth_ = std::max(depth_ - 1, 0); }
    }

    /// A single-line string ends at its line's end at the latest: an unterminated one is not TOML.
    void skip_string(char quote)
    {
        const std::string three(3, quote);
        const bool        many_lines = text_.substr(at_, 3) == three;
        at_ += many_lines ? 3 : 1;
        while (at_ < text_.size())
        {
            if (text_[at_] == '\n' && !many_lines) { return; }
            if (many_lines ? text_.substr(at_, 3) == three : text_[at_] == quote)
            {
                at_ += many_lines ? 3 : 1;
                // Up to two quotes before the closing three belong to the string.
                for (int own = 0; many_lines && own < 2 && text_.substr(at_, 1) == three.substr(0, 1); ++own) { ++at_; }
                return;
            }
            if (text_[at_] == '\n') { ++line_; }
            const bool escapes = quote == '"' && text_[at_] == '\\' && text_.substr(at_ + 1, 1) != "\n";
            at_ += escapes ? 2 : 1;
        }
    }

    Excess excess(const char* what, int count, int most, const char* unit) const
    {
        return {line_, fmt::format("{} {} {} or more", what, count, unit), fmt::format("at most {} {}", most, unit)};
    }

    std::string_view text_;
    std::size_t      at_    = 0;
    std::size_t      line_  = 1;
    int              depth_ = 0;
    int              dots_  = 0;
};

} // namespace

std::optional<Excess> excess_of(std::string_view text)
{
    if (text.size() > most_bytes)
    {
        return Excess{1, fmt::format("a text of {} bytes", text.size()), fmt::format("at most {} bytes", most_bytes)};
    }
    if (auto line = long_line(text)) { return line; }
    if (auto byte = foreign_byte(text)) { return byte; }
    return Scan(text).run();
}

} // namespace tread::scene
