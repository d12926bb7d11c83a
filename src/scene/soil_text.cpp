#include "scene/soil_text.hpp"

#include <fmt/format.h>

#include "scene/soils.hpp"
#include "scene/spellings.hpp"

namespace tread::scene
{
namespace
{

std::string text_of(std::span<const SoilConstant> constants)
{
    std::string text;
    for (const SoilConstant& constant : constants)
    {
        const std::string value = fmt::format("{:.6g} {}", constant.value, constant.unit);
        text += fmt::format("  {:<20}{:<22}{}\n", constant.key, value, constant.source);
    }
    return text;
}

std::string rows_of(std::span<const SoilConstant> constants, const char* prefix)
{
    std::string text;
    for (const SoilConstant& constant : constants)
    {
        text += fmt::format("| {}`{}` | {:.6g} | {} | {} |\n", prefix, constant.key, constant.value, constant.unit,
                            constant.source);
    }
    return text;
}

} // namespace

std::string soils_text()
{
    std::string text;
    for (const Soil& soil : soils())
    {
        text += fmt::format("{}{}: {}\n  {:<20}\"{}\"\n", text.empty() ? "" : "\n", soil.name, soil.what, "model",
                            word_of(soil.model));
        text += text_of(soil.constants);
        if (!soil.bevameter.empty()) { text += "  for the formulas of Wong and Reece:\n" + text_of(soil.bevameter); }
        text += fmt::format("  {}\n", soil.references);
    }
    return text;
}

std::string soils_markdown()
{
    std::string text = soils_heading;
    for (const Soil& soil : soils())
    {
        text += fmt::format("\n### {}\n\n{}. `model = \"{}\"`\n\n", soil.name, soil.what, word_of(soil.model));
        text += "| constant | value | unit | source |\n|---|---|---|---|\n" + rows_of(soil.constants, "");
        text += rows_of(soil.bevameter, "bevameter: ");
        text += fmt::format("| references |  |  | {} |\n", soil.references);
    }
    return text;
}

std::vector<std::string> soil_lines(const Scene& scene)
{
    std::vector<std::string> lines;
    for (const SoilUse& use : scene.soils.of)
    {
        lines.push_back(fmt::format("[{}] takes {} values from soil {}:", use.material, use.taken.size(), use.soil));
        for (const SoilValue& taken : use.taken)
        {
            lines.push_back(fmt::format("  {} = {} ({})", taken.key, taken.value, taken.source));
        }
    }
    return lines;
}

} // namespace tread::scene
