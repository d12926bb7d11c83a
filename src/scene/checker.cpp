#include "scene/checker.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tread::scene
{
namespace
{

/// The table itself, or the innermost existing node that encloses it.
const Node& table_node(const Node& document, const TableAt& at)
{
    const Node* found = find(document, at.name);
    if (found == nullptr) { return document; }
    const auto* array = std::get_if<NodeArray>(&found->value);
    return array != nullptr && at.index < array->size() ? (*array)[at.index] : *found;
}

} // namespace

std::string table_label(const Node& document, const std::string& table, std::size_t index)
{
    const Node* found = find(document, table);
    if (found == nullptr || !std::holds_alternative<NodeArray>(found->value)) { return table; }
    const Node* name = find(table_node(document, {table, index}), "name");
    const auto* text = name != nullptr ? std::get_if<std::string>(&name->value) : nullptr;
    return text != nullptr ? table + "." + *text : fmt::format("{}[{}]", table, index);
}

std::string Checker::label(const TableAt& at) const { return table_label(document, at.name, at.index); }

const Node* Checker::given(const TableAt& at, const std::string& key) const
{
    return find(table_node(document, at), key);
}

bool Checker::sound(const TableAt& at, const std::vector<std::string>& keys) const
{
    const auto table = label(at);
    if (mentions(problems, table, "")) { return false; }
    return std::none_of(keys.begin(), keys.end(),
                        [&](const std::string& key)
                        { return mentions(problems, table, key) || mentions_inside(problems, table + "." + key); });
}

void Checker::report(const TableAt& at, const std::string& key, std::string what, std::string accepted)
{
    const Node* value = given(at, key);
    const auto& where = value != nullptr ? value->where : table_node(document, at).where;
    problems.push_back({where, label(at), key, std::move(what), std::move(accepted)});
}

void Checker::require_known(const TableAt& at, const std::string& key, const std::string& name,
                            const std::vector<std::string>& known, const std::string& kind)
{
    const auto is_known = [&](const std::string& candidate)
    { return std::find(known.begin(), known.end(), candidate) != known.end(); };
    // An empty name is one that could not be read: it may be the one sought.
    if (!sound(at, {key}) || is_known(name) || is_known("")) { return; }
    report(at, key, fmt::format("there is no {} called \"{}\"{}", kind, name, suggestion(name, known)),
           known.empty() ? "" : fmt::format("{}", fmt::join(known, ", ")));
}

} // namespace tread::scene
