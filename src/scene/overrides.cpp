#include "scene/overrides.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "scene/text.hpp"
#include "scene/text_limits.hpp"
#include "scene/values.hpp"

namespace tread::scene
{
namespace
{

/// Follows every line of a file in the order of problems.
constexpr std::int64_t first_override = std::numeric_limits<std::int64_t>::max() / 2;

/// Splits a path: "material[0].young" -> material, 0, young.
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

/// Element with name or index `segment`; nullptr if there is none.
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

bool holds_tables(const NodeArray& array)
{
    return !array.empty() &&
           std::all_of(array.begin(), array.end(),
                       [](const Node& item) { return std::holds_alternative<NodeTable>(item.value); });
}

/// Writes a value as TOML, for messages.
struct AsToml
{
    std::string operator()(const OtherValue& other) const { return other.kind; }
    std::string operator()(bool value) const { return value ? "true" : "false"; }
    std::string operator()(std::int64_t value) const { return fmt::format("{}", value); }
    std::string operator()(double value) const { return write_number(value); }
    std::string operator()(const std::string& text) const { return write_string(shown(text)); }
    std::string operator()(const NodeTable&) const { return "{ ... }"; }
    std::string operator()(const NodeArray& array) const
    {
        std::string text;
        for (const Node& item : array)
        {
            text += fmt::format("{}{}", text.empty() ? "" : ", ", std::visit(*this, item.value));
        }
        return fmt::format("[{}]", text);
    }
};

/// `path` leads to an array without an element called `segment`.
Problem no_such_value(const NodeArray& array, const std::string& path, const std::string& segment,
                      const Location& where)
{
    const std::string whole = fmt::format("{}={}", path, shown(AsToml{}(array)));
    return {where, "", "",
            fmt::format("\"{}\" stands below {}, which is an array of {} values", segment, path, array.size()),
            array.empty() ? whole : fmt::format("{}, or {}[0] to {}[{}]", whole, path, path, array.size() - 1)};
}

/// Node named `segment` below `node`, which is at `path`; created if a table lacks it. nullptr, with a problem
/// reported, if it cannot exist.
Node* descend(Node& node, const std::string& path, const std::string& segment, const Location& where,
              Problems& problems)
{
    if (auto* table = std::get_if<NodeTable>(&node.value))
    {
        return &table->try_emplace(segment, Node{NodeTable{}, where}).first->second;
    }
    if (auto* array = std::get_if<NodeArray>(&node.value))
    {
        if (Node* found = element(*array, segment)) { return found; }
        if (!holds_tables(*array))
        {
            problems.push_back(no_such_value(*array, path, segment, where));
            return nullptr;
        }
        const auto names = names_in(*array);
        problems.push_back({where, "", "",
                            fmt::format("nothing is called \"{}\" there{}", segment, suggestion(segment, names)),
                            fmt::format("index below {}, or a name: {}", array->size(),
                                        shown(fmt::format("{}", fmt::join(names, ", ")), 500))});
        return nullptr;
    }
    problems.push_back({where, "", "", fmt::format("\"{}\" stands below {}", segment, kind_of(node)), ""});
    return nullptr;
}

void apply(Node& document, const std::string& path, const std::string& value, const Location& where, Problems& problems)
{
    Node*       node = &document;
    std::string so_far;
    for (const auto& segment : split_path(path))
    {
        node = descend(*node, so_far, segment, where, problems);
        if (node == nullptr) { return; }
        so_far += (so_far.empty() ? "" : ".") + segment;
    }
    *node = parse_value(value, where);
}

constexpr std::string_view name_letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";

/// Whether a text is a path to a key: a.b, a[0].b ...
bool is_path(std::string_view text)
{
    bool whole = take(text, name_letters);
    while (whole && !text.empty())
    {
        const char joint = text.front();
        text.remove_prefix(1);
        if (joint == '[')
        {
            whole = take(text, "0123456789") && text.substr(0, 1) == "]";
            if (whole) { text.remove_prefix(1); }
        }
        else { whole = joint == '.' && take(text, name_letters); }
    }
    return whole;
}

struct Override
{
    std::string path;
    std::string value;
};

/// Empty if the text is not of the form key=value.
std::optional<Override> split_override(std::string_view text)
{
    const auto equals = text.find('=');
    if (equals == std::string_view::npos) { return std::nullopt; }
    const auto path  = trimmed(text.substr(0, equals));
    auto       value = text.substr(equals + 1);
    take(value, blanks);
    if (!is_path(path) || value.empty()) { return std::nullopt; }
    return Override{std::string(path), std::string(value)};
}

void apply_override(Node& document, const std::string& text, const Location& where, Problems& problems)
{
    if (const auto excess = excess_of(text))
    {
        problems.push_back({where, "", "", excess->what, excess->accepted});
        return;
    }
    const auto override = split_override(text);
    if (!override)
    {
        problems.push_back({where, "", "", "is not of the form key=value", "a.b=c, a.name.b=c or a[0].b=c"});
        return;
    }
    apply(document, override->path, override->value, where, problems);
}

} // namespace

void apply_overrides(Node& document, const std::vector<std::string>& overrides, Problems& problems)
{
    std::int64_t order = first_override;
    for (const auto& text : overrides)
    {
        apply_override(document, text, {fmt::format("--set {}", shown(text)), order++}, problems);
    }
}

} // namespace tread::scene
