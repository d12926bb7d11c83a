#pragma once

#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "scene/document.hpp"
#include "scene/scene.hpp"
#include "scene/spelling.hpp"

// Types of values in a scene: how they are read from TOML, written back, and described in messages and docs.
namespace tread::scene
{

/// Thrown by Value::read; the reader of the table adds file, line, key and the accepted values.
struct BadValue
{
    std::string what;
};

/// One type of value, stored as an M.
template<class M>
struct Value
{
    std::string                          accepted;
    std::function<M(const Node&)>        read;  ///< throws BadValue
    std::function<std::string(const M&)> write; ///< TOML; empty if the value means "not given"
};

/// An interval of finite numbers.
struct Range
{
    double low       = -std::numeric_limits<double>::infinity();
    double high      = std::numeric_limits<double>::infinity();
    bool   with_low  = true;
    bool   with_high = true;

    bool        contains(double value) const;
    std::string text() const; ///< "number > 0 and <= 1"
};

Range between(double low, double high);     ///< [low, high]
Range from_below(double low, double high);  ///< [low, high)
Range above_up_to(double low, double high); ///< (low, high]

/// Reads a finite number, or a TOML integer. BadValue outside the range.
double read_number(const Node& node, const Range& range);

/// Reads an integer. BadValue outside [low, high].
std::int64_t read_integer(const Node& node, std::int64_t low, std::int64_t high);

/// Reads a string. BadValue if `node` is not one.
const std::string& read_string(const Node& node);

/// Elements of an array. BadValue if `node` is not one.
const NodeArray& read_list(const Node& node);

/// Elements of an array. BadValue unless there are `size` of them.
const NodeArray& read_array(const Node& node, std::size_t size);

/// Shortest decimal that reads back as the same double, recognisable as a float.
std::string write_number(double value);

/// Writes a quoted TOML string.
std::string write_string(const std::string& text);

/// A number in range. A value out of range (0 if only > 0 is accepted) means "not given" and is not written.
Value<double> number(Range range);

/// 0, or a number in range.
Value<double> zero_or(Range range);

/// A number in range. `word` means "empty"; if `word` is empty, absence does.
Value<std::optional<double>>       number_or(const std::string& word, Range range);
Value<std::optional<std::int64_t>> integer_or(const std::string& word, std::int64_t low,
                                              std::int64_t high = std::numeric_limits<std::int64_t>::max());

/// An integer in [low, high]; absence gives an empty optional.
Value<std::optional<std::int64_t>> integer_given(std::int64_t low, std::int64_t high);

/// Three numbers, each in range; the second may be left out.
Value<Vector3>                vector3(Range range);
Value<std::optional<Vector3>> vector3_given(Range range);

/// Two numbers, each in range.
Value<Vector2> vector2(Range range);

/// Two numbers, each in range; absence gives an empty optional.
Value<std::optional<Vector2>> vector2_given(Range range);

/// A vector other than 0, of any length; absence of the second gives an empty optional.
Value<Vector3>                direction();
Value<std::optional<Vector3>> direction_given();

/// Rows of a rotation, orthonormal to 1e-6; absence gives an empty optional.
Value<std::optional<Matrix3>> rotation_given();

/// true or false; absence gives an empty optional.
Value<bool>                boolean();
Value<std::optional<bool>> boolean_given();

/// Any string.
Value<std::string> text();

/// A non-empty string; absence gives an empty one.
Value<std::string> path();

/// A string of letters, digits, '_' and '-', so that it can be used in paths, HDF5 names and --set arguments.
Value<std::string> name();

/// An array of names.
Value<std::vector<std::string>> names();

/// An array of distinct words from `words`.
Value<std::vector<std::string>> words_of(const std::vector<std::string>& words);

/// One of `words`; absence gives an empty string.
Value<std::string> one_of(const std::vector<std::string>& words);

/// Two names.
Value<std::array<std::string, 2>> pair_of_names();

/// [[x, y, z], [x, y, z]], the second above the first in each component; absence gives an empty optional.
Value<std::optional<Box>> box_given();

/// An array of boxes.
Value<std::vector<Box>> boxes();

/// [[x, y], [x, y]], the second above the first in both; absence gives an empty optional.
Value<std::optional<PlanExtent>> extent_given();

/// Metres per mesh unit: a word of length or a number.
Value<double> length_unit();

/// An integer in [low, high], stored as an M.
template<class M>
Value<M> integer(std::int64_t low, std::int64_t high = std::numeric_limits<std::int64_t>::max())
{
    const bool  bounded  = high != std::numeric_limits<std::int64_t>::max();
    std::string accepted = bounded ? fmt::format("integer {} to {}", low, high) : fmt::format("integer >= {}", low);
    return {std::move(accepted), [=](const Node& node) { return static_cast<M>(read_integer(node, low, high)); },
            [](const M& value) { return fmt::format("{}", value); }};
}

/// An integer from a list of choices.
Value<int> integer_of(std::vector<int> choices);

/// Reads a word and returns its index in `words`.
std::size_t read_word(const Node& node, const std::vector<std::string>& words);

/// Formats a list of words as `"a" | "b"`.
std::string list_words(const std::vector<std::string>& words);

/// Words of an enumeration, in the order of its enumerators.
template<class E>
std::vector<std::string> words_of_enumeration()
{
    std::vector<std::string> words;
    words.reserve(std::size(spellings<E>));
    for (const Spelling<E>& spelling : spellings<E>) { words.emplace_back(spelling.word); }
    return words;
}

/// An enumeration, by its words: spellings.hpp.
template<class E>
Value<E> word()
{
    static_assert(!spellings<E>.empty(), "include scene/spellings.hpp");
    const std::vector<std::string> words = words_of_enumeration<E>();
    return {list_words(words), [words](const Node& node) { return spellings<E>.at(read_word(node, words)).value; },
            [](const E& value) { return write_string(word_of(value)); }};
}

} // namespace tread::scene
