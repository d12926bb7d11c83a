#include "scene/soil_filling.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "scene/checker.hpp"
#include "scene/keys.hpp"
#include "scene/soils.hpp"
#include "scene/spellings.hpp"

namespace tread::scene
{
namespace
{

/// Largest difference of relative densities that counts as agreement: they are written with two decimals.
constexpr double rounding = 0.01;

/// A [[material]] of the document that names a soil.
struct Place
{
    NodeTable&  table;
    Location    where; ///< of the key `soil`
    std::string label;

    void report(const char* key, std::string what, std::string accepted, Problems& problems) const
    {
        const auto given = table.find(key);
        problems.push_back(
            {given == table.end() ? where : given->second.where, label, key, std::move(what), std::move(accepted)});
    }
};

/// Constants of the bed and the angle that a law needs: those of a soil hold for its own model only.
bool belongs_to_model(std::string_view key) { return key == "density" || key == "friction_angle_deg"; }

/// Empty if the key is left out, or is no finite number, which its reader reports.
std::optional<double> number_at(const NodeTable& table, const char* key)
{
    const auto found = table.find(key);
    if (found == table.end()) { return std::nullopt; }
    const auto* whole = std::get_if<std::int64_t>(&found->second.value);
    if (whole != nullptr) { return static_cast<double>(*whole); }
    const auto* real = std::get_if<double>(&found->second.value);
    return real != nullptr && std::isfinite(*real) ? std::optional(*real) : std::nullopt;
}

/// Model of the table, or else of the soil; empty if the table's cannot be read.
std::optional<MaterialModel> model_of(const NodeTable& table, const Soil& soil)
{
    const auto found = table.find("model");
    if (found == table.end()) { return soil.model; }
    const auto* word = std::get_if<std::string>(&found->second.value);
    for (const auto& [model, spelling] : spellings<MaterialModel>)
    {
        if (word != nullptr && *word == spelling) { return model; }
    }
    return std::nullopt;
}

/// Whether a key of [[material]] exists and has a meaning under this model.
bool takes(MaterialModel model, std::string_view name)
{
    Material material;
    material.model = model;
    for (const auto& key : material_keys())
    {
        if (key.text.name == name) { return key.applies(material); }
    }
    return false;
}

/// Adds the constants of `soil` that the table leaves out.
SoilUse fill(const Place& place, const Soil& soil, MaterialModel model)
{
    SoilUse use{place.label, soil.name, {}};
    if (place.table.try_emplace("model", Node{std::string(word_of(model)), place.where}).second)
    {
        use.taken.push_back({"model", write_string(word_of(model)), "the law that these constants are for"});
    }
    for (const SoilConstant& constant : soil.constants)
    {
        if (!takes(model, constant.key) || (belongs_to_model(constant.key) && model != soil.model)) { continue; }
        if (place.table.try_emplace(constant.key, Node{constant.value, place.where}).second)
        {
            use.taken.push_back({constant.key, write_number(constant.value), constant.source});
        }
    }
    return use;
}

/// Void ratios of the loosest and the densest packing, and density of the grains (kg/m3).
struct Packing
{
    double loosest;
    double densest;
    double grains;

    double density_at(double relative) const { return grains / (1 + loosest - relative * (loosest - densest)); }
    double relative_at(double density) const { return (loosest - (grains / density - 1)) / (loosest - densest); }

    std::string densities() const { return fmt::format("{:.6g} to {:.6g}", density_at(0), density_at(1)); }
};

/// Empty where density and relative density have nothing to do with each other, or a number that relates them is
/// missing or wrong.
std::optional<Packing> packing_of(const NodeTable& table, const Soil& soil)
{
    const auto grains  = constant_of(soil, "grain_density");
    const auto loosest = number_at(table, "void_ratio_max"), densest = number_at(table, "void_ratio_min");
    if (!grains || !loosest || !densest || !(*loosest > *densest && *densest > 0)) { return std::nullopt; }
    return Packing{*loosest, *densest, *grains};
}

void add_derived(const Place& place, const Packing& packing, const char* key, double value, const char* from,
                 SoilUse& use)
{
    place.table.try_emplace(key, Node{value, place.where});
    use.taken.push_back({key, write_number(value), fmt::format("{} and grains of {} kg/m3", from, packing.grains)});
}

/// The table lacks `density`.
void add_density(const Place& place, const Packing& packing, SoilUse& use, Problems& problems)
{
    const auto relative = number_at(place.table, "relative_density");
    if (relative && *relative >= 0 && *relative <= 1)
    {
        add_derived(place, packing, "density", packing.density_at(*relative), "relative_density", use);
    }
    else if (!place.table.contains("relative_density"))
    {
        place.report("relative_density", fmt::format("missing; {} may lie loose or dense", use.soil),
                     fmt::format("number >= 0 and <= 1, or density = {} (kg/m3)", packing.densities()), problems);
    }
}

void check_density(const Place& place, const Packing& packing, double density, SoilUse& use, Problems& problems)
{
    const double found    = packing.relative_at(density);
    const auto   relative = number_at(place.table, "relative_density");
    if (found < -rounding || found > 1 + rounding)
    {
        const char* where = found < 0 ? "below the loosest" : "above the densest";
        place.report("density", fmt::format("{} is {} packing of {}", density, where, use.soil),
                     packing.densities() + " (kg/m3)", problems);
    }
    else if (!place.table.contains("relative_density"))
    {
        add_derived(place, packing, "relative_density", std::clamp(found, 0.0, 1.0), "density", use);
    }
    else if (relative && std::abs(*relative - found) > rounding)
    {
        place.report(
            "relative_density",
            fmt::format("{} contradicts density = {}, which is {:.3f} of {}", *relative, density, found, use.soil),
            fmt::format("{:.3f}, or one of the two left out", found), problems);
    }
}

/// Adds values that no run sees, so that a problem that has been reported is reported alone.
void stand_in(const Place& place, MaterialModel model)
{
    constexpr double density = 1500, relative = 0.5;
    place.table.try_emplace("density", Node{density, place.where});
    if (takes(model, "relative_density")) { place.table.try_emplace("relative_density", Node{relative, place.where}); }
}

/// Fills a table whose soil is unknown, which the reader of the key reports.
void fill_unknown(const Place& place)
{
    Soil any  = soils().front();
    any.model = model_of(place.table, any).value_or(any.model);
    fill(place, any, any.model);
    stand_in(place, any.model);
}

SoilUse fill_known(const Place& place, const Soil& soil, Problems& problems)
{
    const auto model = model_of(place.table, soil);
    if (!model) { return {place.label, soil.name, {}}; }
    SoilUse    use     = fill(place, soil, *model);
    const auto packing = packing_of(place.table, soil);
    if (*model == MaterialModel::bolton && packing)
    {
        const auto density = number_at(place.table, "density");
        if (!place.table.contains("density")) { add_density(place, *packing, use, problems); }
        else if (density && *density > 0) { check_density(place, *packing, *density, use, problems); }
        stand_in(place, *model);
    }
    return use;
}

} // namespace

SoilUses fill_from_soils(Node& document, Problems& problems)
{
    SoilUses uses;
    auto*    root = std::get_if<NodeTable>(&document.value);
    if (root == nullptr || !root->contains("material")) { return uses; }
    auto* materials = std::get_if<NodeArray>(&root->at("material").value);
    for (std::size_t i = 0; materials != nullptr && i < materials->size(); ++i)
    {
        Node&       material = (*materials)[i];
        const Node* name     = find(material, "soil");
        if (name == nullptr) { continue; }
        const Place place{std::get<NodeTable>(material.value), name->where, table_label(document, "material", i)};
        const auto* text = std::get_if<std::string>(&name->value);
        const Soil* soil = text != nullptr ? find_soil(*text) : nullptr;
        if (soil == nullptr) { fill_unknown(place); }
        else { uses.of.push_back(fill_known(place, *soil, problems)); }
    }
    return uses;
}

} // namespace tread::scene
