#include "scene/values.hpp"

#include <algorithm>
#include <array>
#include <set>

#include <fmt/format.h>

#include "scene/array_values.hpp"
#include "scene/problems.hpp"

namespace tread::scene
{
namespace
{

constexpr std::array<std::pair<const char*, double>, 4> length_units{
    {{"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}}};

constexpr const char* name_letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";

const std::string& read_name(const Node& node)
{
    const auto& text = read_string(node);
    if (text.empty() || text.find_first_not_of(name_letters) != std::string::npos)
    {
        throw BadValue{fmt::format("\"{}\" is not a name", text)};
    }
    return text;
}

std::vector<std::string> distinct(std::vector<std::string> words)
{
    std::set<std::string> seen;
    for (const auto& word : words)
    {
        if (!seen.insert(word).second) { throw BadValue{fmt::format("\"{}\" stands twice", word)}; }
    }
    return words;
}

} // namespace

bool Range::contains(double value) const
{
    if (!std::isfinite(value)) { return false; }
    return (with_low ? value >= low : value > low) && (with_high ? value <= high : value < high);
}

std::string Range::text() const
{
    std::string limits;
    if (std::isfinite(low)) { limits += fmt::format(" {} {:.6g}", with_low ? ">=" : ">", low); }
    if (std::isfinite(high))
    {
        limits += fmt::format("{} {} {:.6g}", limits.empty() ? "" : " and", with_high ? "<=" : "<", high);
    }
    return limits.empty() ? "finite number" : "number" + limits;
}

Range between(double low, double high) { return {low, high, true, true}; }
Range from_below(double low, double high) { return {low, high, true, false}; }
Range above_up_to(double low, double high) { return {low, high, false, true}; }

double read_number(const Node& node, const Range& range)
{
    double value = 0;
    if (const auto* real = std::get_if<double>(&node.value)) { value = *real; }
    else if (const auto* whole = std::get_if<std::int64_t>(&node.value)) { value = static_cast<double>(*whole); }
    else { throw BadValue{"wrong type: " + kind_of(node)}; }
    if (!std::isfinite(value)) { throw BadValue{fmt::format("{} is not a finite number", value)}; }
    if (!range.contains(value)) { throw BadValue{fmt::format("{} is out of range", value)}; }
    return value;
}

std::int64_t read_integer(const Node& node, std::int64_t low, std::int64_t high)
{
    const auto* value = std::get_if<std::int64_t>(&node.value);
    if (value == nullptr) { throw BadValue{"wrong type: " + kind_of(node)}; }
    if (*value < low || *value > high) { throw BadValue{fmt::format("{} is out of range", *value)}; }
    return *value;
}

const std::string& read_string(const Node& node)
{
    const auto* text = std::get_if<std::string>(&node.value);
    if (text == nullptr) { throw BadValue{"wrong type: " + kind_of(node)}; }
    return *text;
}

const NodeArray& read_list(const Node& node)
{
    const auto* array = std::get_if<NodeArray>(&node.value);
    if (array == nullptr) { throw BadValue{"wrong type: " + kind_of(node)}; }
    return *array;
}

const NodeArray& read_array(const Node& node, std::size_t size)
{
    const auto& array = read_list(node);
    if (array.size() != size) { throw BadValue{fmt::format("{} elements instead of {}", array.size(), size)}; }
    return array;
}

std::size_t read_word(const Node& node, const std::vector<std::string>& words)
{
    const auto& text  = read_string(node);
    const auto  found = std::find(words.begin(), words.end(), text);
    if (found == words.end()) { throw BadValue{fmt::format("unknown word \"{}\"{}", text, suggestion(text, words))}; }
    return static_cast<std::size_t>(found - words.begin());
}

std::string list_words(const std::vector<std::string>& words)
{
    std::string text;
    for (const auto& word : words) { text += (text.empty() ? "" : " | ") + write_string(word); }
    return text;
}

std::string write_number(double value)
{
    std::string text = fmt::format("{}", value);
    if (text.find_first_of(".en") == std::string::npos) { text += ".0"; }
    return text;
}

std::string write_string(const std::string& text)
{
    std::string quoted = "\"";
    for (const char letter : text)
    {
        if (letter == '"' || letter == '\\') { quoted += std::string("\\") + letter; }
        else if (static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f)
        {
            quoted += fmt::format("\\u{:04X}", static_cast<unsigned>(letter));
        }
        else { quoted += letter; }
    }
    quoted += '"';
    return quoted;
}

Value<double> number(Range range)
{
    return {range.text(), [=](const Node& node) { return read_number(node, range); },
            [=](const double& value) { return range.contains(value) ? write_number(value) : std::string(); }};
}

Value<double> zero_or(Range range)
{
    const auto read = [=](const Node& node)
    { return read_number(node, between(0, range.high)) == 0 ? 0.0 : read_number(node, range); };
    return {"0, or " + range.text(), read, write_number};
}

Value<std::optional<double>> number_or(const std::string& word, Range range)
{
    const auto quoted = word.empty() ? std::string() : write_string(word);
    return {range.text() + (word.empty() ? "" : ", or " + quoted),
            [=](const Node& node) -> std::optional<double>
            {
                const auto* text = std::get_if<std::string>(&node.value);
                if (text != nullptr && !word.empty() && *text == word) { return std::nullopt; }
                return read_number(node, range);
            },
            [=](const std::optional<double>& value) { return value ? write_number(*value) : quoted; }};
}

Value<std::optional<std::int64_t>> integer_or(const std::string& word, std::int64_t low, std::int64_t high)
{
    const auto quoted = write_string(word);
    return {fmt::format("{}, or {}", integer<std::int64_t>(low, high).accepted, quoted),
            [=](const Node& node) -> std::optional<std::int64_t>
            {
                const auto* text = std::get_if<std::string>(&node.value);
                if (text != nullptr && *text == word) { return std::nullopt; }
                return read_integer(node, low, high);
            },
            [=](const std::optional<std::int64_t>& value) { return value ? fmt::format("{}", *value) : quoted; }};
}

Value<std::optional<std::int64_t>> integer_given(std::int64_t low, std::int64_t high)
{
    return {fmt::format("integer {} to {}", low, high),
            [=](const Node& node) -> std::optional<std::int64_t> { return read_integer(node, low, high); },
            [](const std::optional<std::int64_t>& value) { return value ? fmt::format("{}", *value) : std::string(); }};
}

Value<int> integer_of(std::vector<int> choices)
{
    const auto accepted = fmt::format("{}", fmt::join(choices, " | "));
    return {accepted,
            [choices](const Node& node)
            {
                const auto value = read_integer(node, std::numeric_limits<int>::min(), std::numeric_limits<int>::max());
                if (std::find(choices.begin(), choices.end(), value) == choices.end())
                {
                    throw BadValue{fmt::format("{} is out of range", value)};
                }
                return static_cast<int>(value);
            },
            [](const int& value) { return fmt::format("{}", value); }};
}

Value<bool> boolean()
{
    const auto read = [](const Node& node)
    {
        const auto* value = std::get_if<bool>(&node.value);
        if (value == nullptr) { throw BadValue{"wrong type: " + kind_of(node)}; }
        return *value;
    };
    return {"true | false", read, [](const bool& value) { return std::string(value ? "true" : "false"); }};
}

Value<std::optional<bool>> boolean_given()
{
    const Value<bool> given = boolean();
    return {given.accepted, [=](const Node& node) -> std::optional<bool> { return given.read(node); },
            [=](const std::optional<bool>& value) { return value ? given.write(*value) : std::string(); }};
}

Value<std::string> text()
{
    return {"string", [](const Node& node) { return read_string(node); }, write_string};
}

Value<std::string> path()
{
    const auto read = [](const Node& node)
    {
        const std::string& given = read_string(node);
        if (given.empty()) { throw BadValue{"is empty"}; }
        return given;
    };
    return {"path of a file", read,
            [](const std::string& value) { return value.empty() ? std::string() : write_string(value); }};
}

Value<std::string> name()
{
    return {"name of letters, digits, '_' and '-'", [](const Node& node) { return read_name(node); },
            [](const std::string& value) { return value.empty() ? std::string() : write_string(value); }};
}

Value<std::vector<std::string>> names()
{
    return {"array of distinct names", [](const Node& node) { return distinct(read_each(read_list(node), read_name)); },
            [](const std::vector<std::string>& value) { return write_array(value, write_string); }};
}

Value<std::vector<std::string>> words_of(const std::vector<std::string>& words)
{
    const auto read = [words](const Node& node) { return words[read_word(node, words)]; };
    return {"array of distinct words out of " + list_words(words),
            [read](const Node& node) { return distinct(read_each(read_list(node), read)); },
            [](const std::vector<std::string>& value) { return write_array(value, write_string); }};
}

Value<std::string> one_of(const std::vector<std::string>& words)
{
    return {list_words(words), [words](const Node& node) { return words[read_word(node, words)]; },
            [](const std::string& value) { return value.empty() ? std::string() : write_string(value); }};
}

Value<std::array<std::string, 2>> pair_of_names()
{
    return {"array of two names",
            [](const Node& node)
            {
                const auto values = read_each(read_array(node, 2), read_name);
                return std::array<std::string, 2>{values[0], values[1]};
            },
            [](const std::array<std::string, 2>& value)
            { return value[0].empty() ? std::string() : write_array(value, write_string); }};
}

Value<double> length_unit()
{
    const Range              metres = between(1e-9, 1e6);
    std::vector<std::string> words;
    words.reserve(length_units.size());
    for (const auto& unit : length_units) { words.emplace_back(unit.first); }
    return {list_words(words) + ", or " + metres.text() + " of metres",
            [words, metres](const Node& node)
            {
                if (!std::holds_alternative<std::string>(node.value)) { return read_number(node, metres); }
                return length_units[read_word(node, words)].second;
            },
            [](const double& value)
            {
                for (const auto& unit : length_units)
                {
                    if (unit.second == value) { return write_string(unit.first); }
                }
                return write_number(value);
            }};
}

} // namespace tread::scene
