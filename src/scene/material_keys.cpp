#include <string>
#include <vector>

#include <fmt/format.h>

#include "scene/keys.hpp"
#include "scene/ranges.hpp"

namespace tread::scene
{
namespace
{

bool flows(const Material& material) { return is_granular(material.model); }

/// Words of the material models, in the order of the enumeration.
std::vector<std::string> model_words()
{
    return {
#define TREAD_ROW(name, word, kind) word,
        TREAD_MATERIAL_MODELS(TREAD_ROW)
#undef TREAD_ROW
    };
}

/// Condition of the keys that only granular models have, as messages show it.
std::string when_granular()
{
    std::string                    condition;
    const std::vector<std::string> words = model_words();
    for (std::size_t m = 0; m < words.size(); ++m)
    {
        if (!is_granular(static_cast<MaterialModel>(m))) { continue; }
        condition += fmt::format("{}\"{}\"", condition.empty() ? "model = " : " or ", words[m]);
    }
    return condition;
}

bool has_cap(const Material& material) { return material.model == MaterialModel::drucker_prager_cap; }

bool has_cone(const Material& material) { return material.model == MaterialModel::drucker_prager || has_cap(material); }

} // namespace

Keys<Material> material_keys()
{
    const std::string granular = when_granular();
    return {
        required("name", "", &Material::name, name(), "Unique among materials."),
        required("model", "", &Material::model, word<MaterialModel>(model_words()),
                 "Constitutive model of points. Rocks and bodies take \"elastic\" or \"rigid\"; both stay rigid, and "
                 "`young` and `poisson` set the stiffness of their contacts."),
        optional("density", "kg/m3", &Material::density, number(density()),
                 "Of points: in bulk. Of rocks: of the solid.", "required with [[terrain]] and [[rocks]]"),
        optional("young", "Pa", &Material::young, number(stiffness()),
                 "Young's modulus. Of two things that meet, walls included, one must have it.",
                 "required unless rigid; then perfectly stiff"),
        optional("poisson", "", &Material::poisson, number(between(0, 0.499)), "Poisson's ratio."),
        required("friction_angle_deg", "degrees", &Material::friction_angle_deg, number(from_below(0, 90)),
                 "Internal friction angle.")
            .when(granular, flows),
        optional("dilation_angle_deg", "degrees", &Material::dilation_angle_deg, number(from_below(0, 90)),
                 "Dilation angle; at most the friction angle.")
            .when(granular, flows),
        optional("cohesion", "Pa", &Material::cohesion, number(strength()), "Cohesion.").when(granular, flows),
        required(
            "drucker_prager_fit", "", &Material::drucker_prager_fit,
            word<ConeFit>({"compression", "extension", "plane-strain"}),
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
        optional("family", "", &Material::family, name(),
                 "Contact class, looked up in [[contact]]. \"wall\" is reserved for the domain's walls.",
                 "the material's name"),
    };
}

} // namespace tread::scene
