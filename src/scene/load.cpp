#include "scene/load.hpp"

#include <filesystem>
#include <limits>

#include <fmt/format.h>

#include "scene/contacts.hpp"
#include "scene/keys.hpp"
#include "scene/motion_tables.hpp"
#include "scene/overrides.hpp"
#include "scene/slope.hpp"
#include "scene/soil_filling.hpp"
#include "scene/validate.hpp"

namespace tread::scene
{
namespace
{

/// Largest number of tables in a list. A resolved scene holds all pairs of families of that many materials, and each
/// substep solves one system for all joints.
std::size_t most_tables(const std::string& table)
{
    if (table == "material" || table == "joint") { return 100; }
    return table == "contact" ? 10'000 : 1000;
}

template<class T>
void read_member(const Node& document, const std::string& table, const Keys<T>& keys, T& object, Problems& problems)
{
    const Node  empty{NodeTable{}, document.where};
    const Node* node = find(document, table);
    read_table(node != nullptr ? *node : empty, table, keys, object, problems);
}

template<class T>
void read_member(const Node& document, const std::string& table, const Keys<T>& keys, std::vector<T>& objects,
                 Problems& problems)
{
    const Node* node = find(document, table);
    if (node == nullptr) { return; }
    const auto* array = std::get_if<NodeArray>(&node->value);
    if (array == nullptr)
    {
        problems.push_back({node->where, table, "", "wrong type: " + kind_of(*node), fmt::format("[[{}]]", table)});
        return;
    }
    const std::size_t most = most_tables(table);
    if (array->size() > most)
    {
        problems.push_back({(*array)[most].where, "", table, fmt::format("{} tables", array->size()),
                            fmt::format("at most {} tables [[{}]]", most, table)});
        return;
    }
    objects.resize(array->size());
    for (std::size_t i = 0; i < objects.size(); ++i)
    {
        read_table((*array)[i], table_label(document, table, i), keys, objects[i], problems);
    }
}

Scene read_scene(const Node& document, Problems& problems)
{
    Scene scene;
    auto  known = names_of(scene_keys());
    for_each_table(
        [&](const std::string& table, const char*, auto member, const auto& keys)
        {
            read_member(document, table, keys, scene.*member, problems);
            known.push_back(table);
        });
    read_keys(document, "", scene_keys(), known, scene, problems);
    return scene;
}

void complete_materials(Scene& scene)
{
    for (auto& material : scene.materials)
    {
        material.soil.clear();
        if (material.family.empty()) { material.family = material.name; }
        const bool stiff = material.model == MaterialModel::rigid && material.young == 0;
        if (stiff) { material.young = std::numeric_limits<double>::infinity(); }
    }
}

/// Replaces a slope by its vector of gravity, which is all that a loaded scene has.
void complete_gravity(Domain& domain)
{
    if (!domain.slope.gravity) { return; }
    domain.gravity = gravity_on(domain.slope);
    domain.slope   = {};
}

/// A pair with the wall and no given friction gets the wall's default, not the struct's.
void complete_wall_friction(Scene& scene, const Node& document)
{
    for (std::size_t i = 0; i < scene.contacts.size(); ++i)
    {
        auto& contact = scene.contacts[i];
        if (find(std::get<NodeArray>(find(document, "contact")->value)[i], "friction") == nullptr)
        {
            contact.friction = contact_of({}, contact.between[0], contact.between[1]).friction;
        }
    }
}

/// Makes a path absolute; reports a problem at the key if there is no such file.
void complete_path(const Scene& scene, std::string& path, const Node& file, const std::string& label,
                   const std::string& key, const std::string& accepted, Problems& problems)
{
    const auto absolute = (std::filesystem::path(scene.directory) / path).lexically_normal();
    path                = absolute.string();
    std::error_code error;
    if (!std::filesystem::exists(absolute, error))
    {
        problems.push_back({file.where, label, key, fmt::format("there is no file {}", path), accepted});
    }
    else if (!std::filesystem::is_regular_file(absolute, error))
    {
        problems.push_back({file.where, label, key, fmt::format("{} is no regular file", path), accepted});
    }
}

void complete_meshes(Scene& scene, const Node& document, Problems& problems)
{
    for (std::size_t i = 0; i < scene.shapes.size(); ++i)
    {
        auto*       mesh = std::get_if<MeshFile>(&scene.shapes[i].source);
        const Node* file = find(std::get<NodeArray>(find(document, "shape")->value)[i], "file");
        if (mesh == nullptr || file == nullptr) { continue; }
        complete_path(scene, mesh->path, *file, table_label(document, "shape", i), "file", "STL or OBJ", problems);
    }
}

/// Completes a height from a file: makes its path absolute, and sets a missing extent to the domain's plan.
void complete_height(const Scene& scene, std::optional<Height>& height, const Node& table, const std::string& label,
                     const std::string& key, Problems& problems)
{
    auto*       raster = height ? std::get_if<RasterFile>(&*height) : nullptr;
    const Node* given  = find(table, key);
    const Node* file   = given != nullptr ? find(*given, "file") : nullptr;
    if (raster == nullptr || file == nullptr) { return; }
    complete_path(scene, raster->path, *file, label + "." + key, "file", "PGM or CSV", problems);
    if (!raster->extent) { raster->extent = PlanExtent{{{0, 0}, {scene.domain.size[0], scene.domain.size[1]}}}; }
}

template<class T>
void complete_beds(const Scene& scene, std::vector<T>& items, const Node& document, const std::string& table,
                   Problems& problems)
{
    for (std::size_t i = 0; i < items.size(); ++i)
    {
        const Node* from = find(std::get<NodeArray>(find(document, table)->value)[i], "from");
        if (from == nullptr || items[i].from.empty()) { continue; }
        complete_path(scene, items[i].from, *from, table_label(document, table, i), "from", "bed.h5 of a run",
                      problems);
    }
}

void complete_reference(Scene& scene, const Node& document, Problems& problems)
{
    const Node* table = find(document, "reference");
    const Node* file  = table != nullptr ? find(*table, "file") : nullptr;
    if (file == nullptr || scene.reference.file.empty()) { return; }
    complete_path(scene, scene.reference.file, *file, "reference", "file", "CSV", problems);
}

void note_lines(Scene& scene, const Node& document)
{
    for (const char* table : {"domain", "grid", "time", "output"})
    {
        if (const Node* one = find(document, table)) { scene.lines.of[table] = one->where.text; }
    }
    for (const char* table : {"material", "contact", "shape", "terrain", "rocks", "body", "joint", "phase"})
    {
        const Node* list  = find(document, table);
        const auto* items = list != nullptr ? std::get_if<NodeArray>(&list->value) : nullptr;
        for (std::size_t i = 0; items != nullptr && i < items->size(); ++i)
        {
            scene.lines.of[table_label(document, table, i)] = (*items)[i].where.text;
        }
    }
}

template<class T>
void complete_places(Scene& scene, std::vector<T>& items, const Node& document, const std::string& table,
                     Problems& problems)
{
    for (std::size_t i = 0; i < items.size(); ++i)
    {
        const Node& node  = std::get<NodeArray>(find(document, table)->value)[i];
        const auto  label = table_label(document, table, i);
        auto&       item  = items[i];
        if (!item.region.box && !item.region.sphere) { item.region.box = Box{{}, scene.domain.size}; }
        complete_height(scene, item.height, node, label, "height", problems);
        complete_height(scene, item.floor, node, label, "floor", problems);
    }
}

/// Makes a scene of a document; `directory`: base of relative file names.
Scene make_scene(Node document, const std::filesystem::path& directory, const std::vector<std::string>& overrides)
{
    Problems problems;
    apply_overrides(document, overrides, problems);
    SoilUses soils  = fill_from_soils(document, problems);
    Scene    scene  = read_scene(document, problems);
    scene.soils     = std::move(soils);
    scene.directory = directory.string();
    if (problems.size() > most_problems) { throw_if_any(problems); }
    complete_gravity(scene.domain);
    complete_materials(scene);
    complete_wall_friction(scene, document);
    complete_meshes(scene, document, problems);
    complete_beds(scene, scene.terrain, document, "terrain", problems);
    complete_beds(scene, scene.rocks, document, "rocks", problems);
    complete_reference(scene, document, problems);
    complete_motions(scene, document, problems);
    complete_places(scene, scene.terrain, document, "terrain", problems);
    complete_places(scene, scene.rocks, document, "rocks", problems);
    validate(scene, document, problems);
    throw_if_any(problems);
    complete_contacts(scene);
    note_lines(scene, document);
    return scene;
}

} // namespace

Scene load_scene(const std::string& path, const std::vector<std::string>& overrides)
{
    return make_scene(parse_document(path), std::filesystem::absolute(path).parent_path(), overrides);
}

Scene load_scene(const SceneText& source, const std::vector<std::string>& overrides)
{
    return make_scene(parse_document_text(source.text, source.name), std::filesystem::absolute(source.directory),
                      overrides);
}

} // namespace tread::scene
