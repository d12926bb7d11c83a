#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

// What a TOML text may be before it is parsed. The parser calls itself once a level of nesting, and its time grows as
// the square of a line's length: a text beyond these limits would exhaust the stack, or keep it busy for minutes.
namespace tread::scene
{

inline constexpr std::size_t most_bytes    = std::size_t{1} << 20; ///< of a file: some 3000 tables
inline constexpr std::size_t most_line     = std::size_t{1} << 15; ///< bytes of a line: a list of some 500 boxes
inline constexpr int         most_depth    = 32; ///< brackets in each other; the keys of a scene need 4
inline constexpr int         most_segments = 32; ///< of a dotted key; the keys of a scene need 4

/// What makes a text too large to parse.
struct Excess
{
    std::size_t line; ///< counts from 1
    std::string what;
    std::string accepted;
};

/// The first line of a text that is beyond a limit; nothing if the text may be parsed. Brackets and dots in strings and
/// comments do not count.
std::optional<Excess> excess_of(std::string_view text);

} // namespace tread::scene
