#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "scene/problems.hpp"
#include "scene/values.hpp"

// Keys of a TOML table, each bound to a member of the struct that it fills.
namespace tread::scene
{

/// Description of a key for users; the columns of docs/scene.md.
struct KeyText
{
    std::string name;
    std::string unit;     ///< empty if it has none
    std::string fallback; ///< default as TOML, or the meaning of absence; "required"
    std::string accepted;
    std::string meaning;
    std::string condition; ///< `until = "duration"`: the key is refused otherwise; empty if always allowed
};

struct TableText
{
    std::string          title; ///< `[domain]`, `[[phase]] drive`
    std::string          meaning;
    std::vector<KeyText> keys;
};

enum class Presence
{
    required,
    optional
};

template<class T>
struct Key
{
    KeyText                                                                   text;
    Presence                                                                  presence;
    std::function<bool(const T&)>                                             applies; ///< the condition
    std::function<void(const Node&, const std::string& table, T&, Problems&)> read;
    std::function<std::string(const T&)>                                      write; ///< TOML; empty = not given
    std::vector<TableText>                                                    inner; ///< keys of a table-valued key

    /// Restricts the key to tables where `condition` holds; a required key is required only there.
    Key when(std::string condition, std::function<bool(const T&)> holds) &&
    {
        text.condition = std::move(condition);
        applies        = std::move(holds);
        return std::move(*this);
    }
};

template<class T>
using Keys = std::vector<Key<T>>;

/// Returns the object that a table with these keys fills, with its defaults.
template<class T>
T made_by(const Keys<T>&)
{
    return {};
}

template<class T>
std::vector<std::string> names_of(const Keys<T>& keys)
{
    std::vector<std::string> names;
    for (const auto& key : keys) { names.push_back(key.text.name); }
    return names;
}

inline std::string accepted_with_unit(const KeyText& text)
{
    return text.unit.empty() ? text.accepted : text.accepted + " (" + text.unit + ")";
}

/// `access`: member pointer, or function from T& to a reference to the member.
template<class T, class Access, class M>
Key<T> make_key(Presence presence, KeyText text, Access access, Value<M> value)
{
    text.accepted = value.accepted;
    auto write    = [=](const T& object) { return value.write(std::invoke(access, object)); };
    if (text.fallback.empty()) { text.fallback = presence == Presence::required ? "required" : write(T{}); }
    auto read = [=](const Node& node, const std::string& table, T& object, Problems& problems)
    {
        try
        {
            std::invoke(access, object) = value.read(node);
        }
        catch (const BadValue& bad)
        {
            problems.push_back({node.where, table, text.name, bad.what, accepted_with_unit(text)});
        }
    };
    return {text, presence, [](const T&) { return true; }, read, write, {}};
}

template<class T, class M>
Key<T> required(std::string name, std::string unit, M T::*member, Value<M> value, std::string meaning)
{
    KeyText text{std::move(name), std::move(unit), {}, {}, std::move(meaning), {}};
    return make_key<T>(Presence::required, std::move(text), member, std::move(value));
}

/// `fallback` describes the meaning of absence if the member's default does not.
template<class T, class M>
Key<T> optional(std::string name, std::string unit, M T::*member, Value<M> value, std::string meaning,
                std::string fallback = {})
{
    KeyText text{std::move(name), std::move(unit), std::move(fallback), {}, std::move(meaning), {}};
    return make_key<T>(Presence::optional, std::move(text), member, std::move(value));
}

/// Reports a problem for each member of a table that is not among `known`.
inline void check_unknown(const Node& node, const std::string& table, const std::vector<std::string>& known,
                          Problems& problems)
{
    for (const auto& [name, value] : std::get<NodeTable>(node.value))
    {
        if (std::find(known.begin(), known.end(), name) == known.end())
        {
            problems.push_back({value.where, table, name, "unknown key" + suggestion(name, known),
                                fmt::format("{}", fmt::join(known, ", "))});
        }
    }
}

template<class T>
void check_presence(const Node& node, const std::string& table, const Key<T>& key, const T& object, Problems& problems)
{
    const Node* value   = find(node, key.text.name);
    const bool  applies = key.applies(object);
    if (value != nullptr && !applies)
    {
        problems.push_back({value->where, table, key.text.name, "may stand only with " + key.text.condition, ""});
    }
    if (value == nullptr && applies && key.presence == Presence::required)
    {
        problems.push_back({node.where, table, key.text.name, "missing", accepted_with_unit(key.text)});
    }
}

/// Fills `object` from the members of a table named by `keys`; `known` lists further keys that are read elsewhere.
template<class T>
void read_keys(const Node& node, const std::string& table, const Keys<T>& keys, const std::vector<std::string>& known,
               T& object, Problems& problems)
{
    const auto before = problems.size();
    check_unknown(node, table, known, problems);
    for (const auto& key : keys)
    {
        if (const Node* value = find(node, key.text.name)) { key.read(*value, table, object, problems); }
    }
    // Conditions that depend on a misspelt or unreadable key cannot be decided.
    const bool decided = problems.size() == before;
    for (const auto& key : keys)
    {
        if (decided || key.text.condition.empty()) { check_presence(node, table, key, object, problems); }
    }
}

/// Fills `object` from a table that holds only `keys`; `table` names it in messages.
template<class T>
void read_table(const Node& node, const std::string& table, const Keys<T>& keys, T& object, Problems& problems)
{
    if (!std::holds_alternative<NodeTable>(node.value))
    {
        problems.push_back({node.where, table, "", "wrong type: " + kind_of(node), "table"});
        return;
    }
    read_keys(node, table, keys, names_of(keys), object, problems);
}

/// Writes the keys that are given as `name = value`, joined by `separator`.
template<class T>
std::string write_keys(const Keys<T>& keys, const T& object, const std::string& separator)
{
    std::string text;
    for (const auto& key : keys)
    {
        const auto value = key.applies(object) ? key.write(object) : std::string();
        if (!value.empty()) { text += (text.empty() ? "" : separator) + key.text.name + " = " + value; }
    }
    return text;
}

template<class T>
std::string write_inline(const Keys<T>& keys, const T& object)
{
    return "{ " + write_keys(keys, object, ", ") + " }";
}

template<class T>
TableText describe(std::string title, std::string meaning, const Keys<T>& keys)
{
    TableText text{std::move(title), std::move(meaning), {}};
    for (const auto& key : keys) { text.keys.push_back(key.text); }
    return text;
}

/// A key whose value is a table held in a member; `title` is the heading of its keys in docs/scene.md.
template<class T, class Member, class M>
Key<T> table_key(Presence presence, const std::string& name, const std::string& title, Member member,
                 const Keys<M>& keys, const std::string& meaning, std::string fallback)
{
    auto read = [=](const Node& node, const std::string& table, T& object, Problems& problems)
    {
        M value{};
        read_table(node, table + "." + name, keys, value, problems);
        object.*member = value;
    };
    auto write = [=](const T& object)
    {
        if constexpr (std::is_same_v<std::decay_t<decltype(object.*member)>, std::optional<M>>)
        {
            return (object.*member) ? write_inline(keys, *(object.*member)) : std::string();
        }
        else { return write_inline(keys, object.*member); }
    };
    KeyText text{name, "", std::move(fallback), "table, see " + title, meaning, ""};
    return {text, presence, [](const T&) { return true; }, read, write, {describe(title, "", keys)}};
}

/// A key whose value is an array of tables held in a vector; `inner`: headings below that of its keys. Errors name the
/// table as table.name[i].
template<class T, class Member, class M>
Key<T> tables_key(const std::string& name, const std::string& title, Member member, const Keys<M>& keys,
                  const std::string& meaning, std::string fallback, const std::vector<TableText>& inner = {})
{
    const KeyText text{name, "", std::move(fallback), "array of tables, see " + title, meaning, ""};
    auto          read = [=](const Node& node, const std::string& table, T& object, Problems& problems)
    {
        const auto* array = std::get_if<NodeArray>(&node.value);
        if (array == nullptr)
        {
            problems.push_back({node.where, table, name, "wrong type: " + kind_of(node), text.accepted});
            return;
        }
        auto& values = object.*member;
        values.resize(array->size());
        for (std::size_t i = 0; i < array->size(); ++i)
        {
            read_table((*array)[i], fmt::format("{}.{}[{}]", table, name, i), keys, values[i], problems);
        }
    };
    auto write = [=](const T& object)
    {
        std::string list;
        for (const M& value : object.*member) { list += "\n  " + write_inline(keys, value) + ","; }
        return list.empty() ? list : "[" + list + "\n]";
    };
    std::vector<TableText> texts{describe(title, "", keys)};
    texts.insert(texts.end(), inner.begin(), inner.end());
    return {text, Presence::optional, [](const T&) { return true; }, read, write, texts};
}

} // namespace tread::scene
