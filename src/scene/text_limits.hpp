#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

// What a TOML text must keep before it is parsed. The parser recurses for each level of nesting, its time grows as the
// square of a line's length, and it reads past the end of strings that are not UTF-8 (toml11 3.7.1): a text beyond
// these limits would overflow the stack, take minutes or crash.
namespace tread::scene
{

inline constexpr std::size_t most_bytes    = std::size_t{1} << 20; ///< of a file: some 3000 tables
inline constexpr std::size_t most_line     = std::size_t{1} << 15; ///< bytes in a line: a list of some 500 boxes
inline constexpr int         most_depth    = 32; ///< levels of nested brackets; the keys of a scene need 4
inline constexpr int         most_segments = 32; ///< of a dotted key; the keys of a scene need 4

/// Reason why a text is not parsed.
struct Excess
{
    std::size_t line; ///< counts from 1
    std::string what;
    std::string accepted;
};

/// First line of a text that exceeds a limit or is not UTF-8; empty if the text may be parsed. Brackets and dots in
/// strings and comments do not count.
std::optional<Excess> excess_of(std::string_view text);

} // namespace tread::scene
