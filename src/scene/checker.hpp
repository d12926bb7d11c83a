#pragma once

#include "scene/validate.hpp"

namespace tread::scene
{

/// A table of the document: a single one, or the index-th element of an array.
struct TableAt
{
    std::string name;
    std::size_t index = 0;
};

/// Looks up entries of the document for cross checks, and collects problems.
struct Checker
{
    const Node& document;
    Problems&   problems;

    std::string label(const TableAt& at) const;

    /// Value of a key in a table; nullptr if not given.
    const Node* given(const TableAt& at, const std::string& key) const;

    /// Whether all keys were read without a problem, so that their values may be compared.
    bool sound(const TableAt& at, const std::vector<std::string>& keys) const;

    /// Reports a problem at the key, or at its table if the key was not given.
    void report(const TableAt& at, const std::string& key, std::string what, std::string accepted = {});

    /// Reports a problem, naming the expected `kind` of thing, unless `name` is among `known`.
    void require_known(const TableAt& at, const std::string& key, const std::string& name,
                       const std::vector<std::string>& known, const std::string& kind);
};

void validate_names(const Scene& scene, Checker& checker);
void validate_references(const Scene& scene, Checker& checker);
void validate_materials(const Scene& scene, Checker& checker);
void validate_shapes(const Scene& scene, Checker& checker);
void validate_places(const Scene& scene, Checker& checker);
void validate_bodies(const Scene& scene, Checker& checker);
void validate_joints(const Scene& scene, Checker& checker);
void validate_assemblies(const Scene& scene, Checker& checker);
void validate_touch(const Scene& scene, Checker& checker);
void validate_phases(const Scene& scene, Checker& checker);
void validate_motions(const Scene& scene, Checker& checker);
void validate_contents(const Scene& scene, Checker& checker);

/// Whether gravity was read and is zero.
bool is_weightless(const Scene& scene, const Checker& checker);

template<class T>
std::vector<std::string> names_in(const std::vector<T>& items)
{
    std::vector<std::string> names;
    names.reserve(items.size());
    for (const auto& item : items) { names.push_back(item.name); }
    return names;
}

} // namespace tread::scene
