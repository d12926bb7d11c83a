#include "scene/overrides.hpp"

#include <charconv>
#include <limits>
#include <regex>

#include <fmt/format.h>

namespace tread::scene
{
namespace
{

/// After every line of a file.
constexpr std::int64_t first_override = std::numeric_limits<std::int64_t>::max() / 2;

/// "material[0].young" -> material, 0, young
std::vector<std::string> split_path(const std::string& path)
{
    std::vector<std::string> segments(1);
    for (const char letter : path)
    {
        if (letter == '.' || letter == '[') { segments.emplace_back(); }
        else if (letter != ']') { segments.back() += letter; }
    }
    return segments;
}

std::vector<std::string> names_in(const NodeArray& array)
{
    std::vector<std::string> names;
    for (const auto& item : array)
    {
        const Node* name = find(item, "name");
        const auto* text = name != nullptr ? std::get_if<std::string>(&name->value) : nullptr;
        names.push_back(text != nullptr ? *text : std::string());
    }
    return names;
}

/// The element called `segment`, or at that index; nullptr if there is none.
Node* element(NodeArray& array, const std::string& segment)
{
    const auto names = names_in(array);
    for (std::size_t i = 0; i < names.size(); ++i)
    {
        if (names[i] == segment) { return &array[i]; }
    }
    std::size_t index      = 0;
    const auto [end, fail] = std::from_chars(segment.data(), segment.data() + segment.size(), index);
    const bool whole       = fail == std::errc() && end == segment.data() + segment.size();
    return whole && index < array.size() ? &array[index] : nullptr;
}

/// The node that `segment` names below `node`, made if a table lacks it; nullptr, with a problem, if there is no way.
Node* descend(Node& node, const std::string& segment, const Location& where, Problems& problems)
{
    if (auto* table = std::get_if<NodeTable>(&node.value))
    {
        return &table->try_emplace(segment, Node{NodeTable{}, where}).first->second;
    }
    if (auto* array = std::get_if<NodeArray>(&node.value))
    {
        if (Node* found = element(*array, segment)) { return found; }
        const auto names = names_in(*array);
        problems.push_back({where, "", "",
                            fmt::format("nothing is called \"{}\" there{}", segment, suggestion(segment, names)),
                            fmt::format("index below {}, or a name: {}", array->size(), fmt::join(names, ", "))});
        return nullptr;
    }
    problems.push_back({where, "", "", fmt::format("\"{}\" stands below {}", segment, kind_of(node)), ""});
    return nullptr;
}

void apply(Node& document, const std::string& path, const std::string& value, const Location& where, Problems& problems)
{
    Node* node = &document;
    for (const auto& segment : split_path(path))
    {
        node = descend(*node, segment, where, problems);
        if (node == nullptr) { return; }
    }
    *node = parse_value(value, where);
}

} // namespace

void apply_overrides(Node& document, const std::vector<std::string>& overrides, Problems& problems)
{
    const std::regex form(R"(\s*([A-Za-z0-9_-]+(?:\.[A-Za-z0-9_-]+|\[[0-9]+\])*)\s*=\s*(\S(?:.|\n)*))");
    std::int64_t     order = first_override;
    for (const auto& text : overrides)
    {
        const Location where{"--set " + text, order++};
        std::smatch    match;
        if (!std::regex_match(text, match, form))
        {
            problems.push_back({where, "", "", "is not of the form key=value", "a.b=c, a.name.b=c or a[0].b=c"});
            continue;
        }
        apply(document, match[1], match[2], where, problems);
    }
}

} // namespace tread::scene
