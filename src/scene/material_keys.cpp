#include <string>

#include <fmt/format.h>

#include "scene/keys.hpp"
#include "scene/ranges.hpp"
#include "scene/soils.hpp"
#include "scene/spellings.hpp"

namespace tread::scene
{
namespace
{

bool flows(const Material& material) { return is_granular(material.model); }

bool is_bolton(const Material& material) { return material.model == MaterialModel::bolton; }

/// Whether a model takes a dilation angle; Bolton's follows from the density.
bool has_dilation_angle(MaterialModel model) { return is_granular(model) && model != MaterialModel::bolton; }

bool dilates(const Material& material) { return has_dilation_angle(material.model); }

/// Condition of the keys that only some models have, as messages show it.
std::string when(bool (*wanted)(MaterialModel))
{
    std::string condition;
    for (const auto& [model, word] : spellings<MaterialModel>)
    {
        if (!wanted(model)) { continue; }
        condition += fmt::format("{}\"{}\"", condition.empty() ? "model = " : " or ", word);
    }
    return condition;
}

bool is_nonlocal(const Material& material) { return is_bolton(material) && material.softening_length.has_value(); }

/// The pressure of a cap follows a law of its own.
bool may_stiffen(MaterialModel model) { return is_granular(model) && model != MaterialModel::drucker_prager_cap; }

bool stiffens(const Material& material) { return may_stiffen(material.model); }

bool has_cap(const Material& material) { return material.model == MaterialModel::drucker_prager_cap; }

bool has_cone(const Material& material) { return material.model == MaterialModel::drucker_prager || has_cap(material); }

} // namespace

Keys<Material> material_keys()
{
    const std::string granular = when(is_granular), given = when(has_dilation_angle);
    const std::string bolton = "model = \"bolton\"";
    return {
        required("name", "", &Material::name, name(), "Unique among materials."),
        optional("soil", "", &Material::soil, one_of(soil_names()),
                 "Published soil whose constants fill the keys that the table leaves out: docs/soils.md. The resolved "
                 "scene has the constants.",
                 "the table has all keys"),
        required("model", "", &Material::model, word<MaterialModel>(),
                 "Constitutive model of points. Rocks and bodies take \"elastic\" or \"rigid\"; both stay rigid, and "
                 "`young` and `poisson` set the stiffness of their contacts."),
        optional("density", "kg/m3", &Material::density, number(density()),
                 "Of points: in bulk. Of rocks: of the solid.", "required with [[terrain]] and [[rocks]]"),
        optional("young", "Pa", &Material::young, number(stiffness()),
                 "Young's modulus. Of two things that meet, walls included, one must have it.",
                 "required unless rigid; then perfectly stiff"),
        optional("poisson", "", &Material::poisson, number(between(0, 0.499)), "Poisson's ratio."),
        optional("young_pressure", "Pa", &Material::young_pressure, number(between(0, 1e12)),
                 "Mean stress under which the modulus is `young`. Below it stiffness falls as the root of the mean "
                 "stress, above it stays nearly constant. Wants no cohesion. 0: one modulus for all pressures; "
                 "docs/theory.md#stiffness-with-pressure.")
            .when(when(may_stiffen), stiffens),
        required("friction_angle_deg", "degrees", &Material::friction_angle_deg, number(from_below(0, 90)),
                 "Internal friction angle; with \"bolton\" that of the critical state, at most 60.")
            .when(granular, flows),
        optional("dilation_angle_deg", "degrees", &Material::dilation_angle_deg, number(from_below(0, 90)),
                 "Dilation angle; at most the friction angle.")
            .when(given, dilates),
        optional("cohesion", "Pa", &Material::cohesion, number(strength()), "Cohesion.").when(granular, flows),
        required(
            "drucker_prager_fit", "", &Material::drucker_prager_fit, word<ConeFit>(),
            "Where the cone has the strength of the friction angle and cohesion: in triaxial compression (stronger "
            "elsewhere), in triaxial extension (weaker elsewhere), or in plane strain.")
            .when("model = \"drucker-prager\" or \"drucker-prager-cap\"", has_cone),
        required("cap_pressure", "Pa", &Material::cap_pressure, number(between(1, 1e12)),
                 "Pressure at which sand that was never loaded starts to compact. Sand that starts under a higher one, "
                 "by its own weight, starts to compact at that.")
            .when("model = \"drucker-prager-cap\"", has_cap),
        required("cap_index", "", &Material::cap_index, number(between(1e-6, 10)),
                 "Log volume strain of compaction that raises the cap's pressure by a factor of e.")
            .when("model = \"drucker-prager-cap\"", has_cap),
        required("relative_density", "", &Material::relative_density, number(between(0, 1)),
                 "Relative density (e_max - e) / (e_max - e_min) at the start.")
            .when(bolton, is_bolton),
        required("void_ratio_min", "", &Material::void_ratio_min, number(between(0.05, 5)),
                 "Void ratio e_min of the densest packing; below `void_ratio_max`.")
            .when(bolton, is_bolton),
        required("void_ratio_max", "", &Material::void_ratio_max, number(between(0.05, 5)),
                 "Void ratio e_max of the loosest packing.")
            .when(bolton, is_bolton),
        optional("bolton_q", "", &Material::bolton_q, number(between(5.5, 12)),
                 "Strength Q of the grains: 10 for quartz and feldspar, 8 for limestone, 5.5 for chalk.")
            .when(bolton, is_bolton),
        optional(
            "bolton_fit", "", &Material::bolton_fit, word<BoltonFit>(),
            "Tests to which the friction angle is fitted: 3 degrees (triaxial compression) or 5 (plane strain) per "
            "unit of the dilatancy index.")
            .when(bolton, is_bolton),
        optional("softening_length", "m", &Material::softening_length, number_or("", length()),
                 "The law sees the density as a mean over the surroundings, weighted by a bell curve of this standard "
                 "deviation, so that thickness of shear bands and softening are not the grid's. At least one cell; "
                 "docs/theory.md#softening-length.",
                 "each point's own density")
            .when(bolton, is_bolton),
        optional("nonlocal_weight", "", &Material::nonlocal_weight, number(between(1, 10)),
                 "Weight m of the mean density in the one that the law sees; the point's own has 1 - m. With 1 bands "
                 "stay as thick as cells.")
            .when("softening_length given", is_nonlocal),
        optional("family", "", &Material::family, name(),
                 "Contact class, looked up in [[contact]]. \"wall\" is reserved for the domain's walls.",
                 "the material's name"),
    };
}

} // namespace tread::scene
