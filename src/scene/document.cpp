#include "scene/document.hpp"

#include <filesystem>
#include <fstream>
#include <limits>
#include <regex>
#include <sstream>

#include <fmt/format.h>
#include <toml.hpp>

#include "base/errors.hpp"

namespace tread::scene
{
namespace
{

Location location_of(const toml::value& value, const std::string& file)
{
    const auto line = value.location().line();
    return {fmt::format("{}:{}", file, line), static_cast<std::int64_t>(line)};
}

/// T or, as toml11 reads what T cannot hold as the largest or lowest T, the news of that.
template<class T>
decltype(Node::value) held(T number)
{
    using Limits = std::numeric_limits<T>;
    if (number == Limits::max() || number == Limits::lowest()) { return OtherValue{"a number too large to hold"}; }
    return number;
}

/// `locate` maps a toml::value to the Location that its node shall carry.
template<class Locate>
Node convert(const toml::value& value, const Locate& locate)
{
    Node node{OtherValue{"a date or time"}, locate(value)};
    if (value.is_boolean()) { node.value = value.as_boolean(); }
    else if (value.is_integer()) { node.value = held(value.as_integer()); }
    else if (value.is_floating()) { node.value = held(value.as_floating()); }
    else if (value.is_string()) { node.value = value.as_string().str; }
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

/// toml11 answers with a drawing of several lines; this keeps its first sentence and the last place that it points to:
/// where the second of two keys stands, not the first.
std::string syntax_message(const std::string& file, const std::string& drawing)
{
    const std::regex place("\n *([0-9]+) \\|[^\n]*\n *\\| *(?:~+|\\^-+) *([^\n]*)");
    const std::regex origin("^\\[error\\] *(?:toml::[A-Za-z_:]+ *:? *)?");
    std::string      line = "1";
    std::string      remark;
    for (std::sregex_iterator match(drawing.begin(), drawing.end(), place), end; match != end; ++match)
    {
        line   = (*match)[1];
        remark = (*match)[2];
    }
    const auto sentence = std::regex_replace(drawing.substr(0, drawing.find('\n')), origin, std::string());
    return fmt::format("{}:{}: malformed TOML: {} ({})", file, line, sentence, remark);
}

std::string read_file(const std::string& path)
{
    std::error_code error;
    if (!std::filesystem::exists(path, error)) { throw InputError(path + ": no such file"); }
    if (!std::filesystem::is_regular_file(path, error)) { throw InputError(path + ": not a file"); }
    std::ifstream      stream(path, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    if (!stream) { throw InputError(path + ": cannot be read"); }
    return text.str();
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
        std::string operator()(const std::string& text) const { return fmt::format("the string \"{}\"", text); }
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

Node parse_document(const std::string& path)
{
    std::istringstream text(read_file(path));
    try
    {
        const auto root = toml::parse(text, path);
        return convert(root, [&](const toml::value& value) { return location_of(value, path); });
    }
    catch (const std::exception& error)
    {
        throw InputError(syntax_message(path, error.what()));
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
