#include "scene/document.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <new>
#include <optional>
#include <sstream>
#include <string_view>

#include <fmt/format.h>
#include <toml.hpp>

#include "base/errors.hpp"
#include "scene/text.hpp"
#include "scene/text_limits.hpp"

namespace tread::scene
{
namespace
{

/// Finds line numbers of a document's values. The `location` of toml11 3 copies a value's whole line and counts lines
/// from the beginning of the file, for every value; 4 has counted them.
class LineNumbers
{
public:
    LineNumbers(std::string file, std::string_view text)
        : file_(std::move(file))
    {
        for (std::size_t at = 0; at < text.size(); ++at)
        {
            if (text[at] == '\n') { ends_.push_back(static_cast<std::ptrdiff_t>(at)); }
        }
    }

    Location operator()(const toml::value& value) const
    {
        const std::int64_t line = line_of(value);
        return {fmt::format("{}:{}", file_, line), line};
    }

private:
    template<class Value>
    std::int64_t line_of(const Value& value) const
    {
        using namespace toml::detail; // get_region, which only toml11 3 has
        if constexpr (requires { get_region(value); })
        {
            const auto begin_of = [](const auto* region)
            { return region != nullptr ? region->first() - region->begin() : 0; };
            const auto at = begin_of(dynamic_cast<const toml::detail::region*>(get_region(value)));
            return 1 + (std::lower_bound(ends_.begin(), ends_.end(), at) - ends_.begin());
        }
        else { return static_cast<std::int64_t>(value.location().first_line_number()); }
    }

    std::string                 file_;
    std::vector<std::ptrdiff_t> ends_;
};

/// Returns a T, or an OtherValue where toml11 has clamped a number that T cannot hold to the largest or lowest T.
template<class T>
decltype(Node::value) held(T number)
{
    using Limits = std::numeric_limits<T>;
    if (number == Limits::max() || number == Limits::lowest()) { return OtherValue{"a number too large to hold"}; }
    return number;
}

/// A string of toml11 3, which is a struct, or of 4.
template<class String>
const std::string& text_of(const String& string)
{
    if constexpr (requires { string.str; }) { return string.str; }
    else { return string; }
}

/// `locate` maps a toml::value to the Location of its node.
template<class Locate>
Node convert(const toml::value& value, const Locate& locate)
{
    Node node{OtherValue{"a date or time"}, locate(value)};
    if (value.is_boolean()) { node.value = value.as_boolean(); }
    else if (value.is_integer()) { node.value = held(value.as_integer()); }
    else if (value.is_floating()) { node.value = held(value.as_floating()); }
    else if (value.is_string()) { node.value = text_of(value.as_string()); }
    else if (value.is_array())
    {
        NodeArray array;
        for (const auto& item : value.as_array()) { array.push_back(convert(item, locate)); }
        node.value = std::move(array);
    }
    else if (value.is_table())
    {
        NodeTable table;
        for (const auto& [key, item] : value.as_table()) { table.emplace(key, convert(item, locate)); }
        node.value = std::move(table);
    }
    return node;
}

/// Line number in a diagram's line "12 | text"; empty if it has none.
std::string_view drawn_line(std::string_view line)
{
    take(line, " ");
    std::string_view rest = line;
    if (!take(rest, "0123456789") || rest.substr(0, 2) != " |") { return {}; }
    return line.substr(0, line.size() - rest.size());
}

/// Remark in a diagram's line "| ^^^ remark"; empty if it underlines nothing.
std::optional<std::string> remark_of(std::string_view line)
{
    take(line, " ");
    if (line.substr(0, 1) != "|") { return std::nullopt; }
    line.remove_prefix(1);
    take(line, " ");
    if (!take(line, "~^-")) { return std::nullopt; }
    take(line, " ");
    return std::string(line);
}

std::string_view without_origin(std::string_view sentence)
{
    constexpr std::string_view error = "[error]", space = "toml::";
    if (sentence.substr(0, error.size()) == error) { sentence.remove_prefix(error.size()); }
    take(sentence, " ");
    if (sentence.substr(0, space.size()) != space) { return sentence; }
    take(sentence, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_:");
    take(sentence, " :");
    return sentence;
}

/// Shortens toml11's error, a diagram of several lines, to its first sentence and the last location it marks: for a
/// duplicate key that is the second one, not the first.
std::string syntax_message(const std::string& file, const std::string& drawing)
{
    constexpr std::size_t most = 200;
    std::istringstream    lines(drawing);
    std::string           sentence, line, number = "1", remark;
    std::string           drawn;
    std::getline(lines, sentence);
    while (std::getline(lines, line))
    {
        if (const auto said = remark_of(line); said && !drawn.empty())
        {
            number = drawn;
            remark = *said;
        }
        drawn = drawn_line(line);
    }
    return fmt::format("{}:{}: malformed TOML: {} ({})", file, number, shown(without_origin(sentence), most),
                       shown(remark, most));
}

std::string read_file(const std::string& path)
{
    std::error_code error;
    if (!std::filesystem::exists(path, error)) { throw InputError(path + ": no such file"); }
    if (!std::filesystem::is_regular_file(path, error)) { throw InputError(path + ": not a file"); }
    const auto bytes = std::filesystem::file_size(path, error);
    if (!error && bytes > most_bytes)
    {
        throw InputError(fmt::format("{}: a file of {} bytes; accepted: at most {} bytes", path, bytes, most_bytes));
    }
    std::ifstream      stream(path, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    if (!stream) { throw InputError(path + ": cannot be read"); }
    return text.str();
}

/// Removes a byte order mark, which some editors put before UTF-8.
std::string without_mark(const std::string& text)
{
    constexpr std::string_view mark = "\xef\xbb\xbf";
    return text.compare(0, mark.size(), mark) == 0 ? text.substr(mark.size()) : text;
}

} // namespace

std::string kind_of(const Node& node)
{
    struct Names
    {
        std::string operator()(const OtherValue& other) const { return other.kind; }
        std::string operator()(bool) const { return "a boolean"; }
        std::string operator()(std::int64_t) const { return "an integer"; }
        std::string operator()(double) const { return "a floating-point number"; }
        std::string operator()(const std::string& text) const { return fmt::format("the string \"{}\"", shown(text)); }
        std::string operator()(const NodeArray&) const { return "an array"; }
        std::string operator()(const NodeTable&) const { return "a table"; }
    };
    return std::visit(Names{}, node.value);
}

const Node* find(const Node& node, const std::string& key)
{
    const auto* table = std::get_if<NodeTable>(&node.value);
    if (table == nullptr) { return nullptr; }
    const auto found = table->find(key);
    return found == table->end() ? nullptr : &found->second;
}

Node parse_document(const std::string& path) { return parse_document_text(without_mark(read_file(path)), path); }

Node parse_document_text(const std::string& text, const std::string& name)
{
    if (const auto excess = excess_of(text))
    {
        throw InputError(fmt::format("{}:{}: {}; accepted: {}", name, excess->line, excess->what, excess->accepted));
    }
    std::istringstream stream(text);
    try
    {
        const auto root = toml::parse(stream, name);
        return convert(root, LineNumbers(name, text));
    }
    catch (const std::bad_alloc&)
    {
        throw;
    }
    catch (const std::exception& error)
    {
        throw InputError(syntax_message(name, error.what()));
    }
}

Node parse_value(const std::string& text, const Location& where)
{
    std::istringstream document("value = " + text + "\n");
    try
    {
        const auto root = toml::parse(document, "--set");
        if (root.as_table().size() == 1)
        {
            return convert(root.as_table().at("value"), [&](const toml::value&) { return where; });
        }
    }
    catch (const std::exception&)
    {
        return {text, where};
    }
    return {text, where};
}

} // namespace tread::scene
