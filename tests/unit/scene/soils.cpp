#include "scene/soils.hpp"

#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "scene/keys.hpp"
#include "scene/resolved.hpp"
#include "scene/soil_text.hpp"
#include "scene/spellings.hpp"
#include "scene/values.hpp"
#include "scene_file.hpp"

namespace tread::scene::test
{
namespace
{

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

// ctest runs this program in tests/.
constexpr const char* page     = "../docs/soils.md";
constexpr const char* measured = "../configs/validation/";

std::string text_of(const std::string& path)
{
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

/// The good scene with sand of these keys.
std::string with_sand(const std::string& keys)
{
    return replaced(good_scene,
                    "model = \"mohr-coulomb\"\ndensity = 1600\nyoung = 1e6\npoisson = 0.3\nfriction_angle_deg = 30\n"
                    "dilation_angle_deg = 5\n",
                    keys);
}

Scene load_sand(const std::string& keys, const std::vector<std::string>& overrides = {})
{
    const Directory directory;
    return load_scene(directory.write("scene.toml", with_sand(keys)), overrides);
}

Material sand(const std::string& keys, const std::vector<std::string>& overrides = {})
{
    return load_sand(keys, overrides).materials[0];
}

/// What a table has to write besides `soil`.
std::string needed_by(const Soil& soil)
{
    if (soil.model == MaterialModel::bolton) { return "relative_density = 0.25\n"; }
    return constant_of(soil, "density") ? "" : "density = 1700\n";
}

std::string naming(const Soil& soil) { return fmt::format("soil = \"{}\"\n{}", soil.name, needed_by(soil)); }

TEST(SoilLibrary, HasNamesOfItsOwnAndASourceForEachConstant)
{
    std::set<std::string> names;
    const auto            known = names_of(material_keys());
    for (const Soil& soil : soils())
    {
        EXPECT_TRUE(names.insert(soil.name).second) << soil.name;
        EXPECT_EQ(find_soil(soil.name), &soil);
        for (const SoilConstant& constant : soil.constants)
        {
            EXPECT_STRNE(constant.source, "") << soil.name << "." << constant.key;
            const bool is_key = std::find(known.begin(), known.end(), constant.key) != known.end();
            EXPECT_TRUE(is_key || std::string(constant.key) == "grain_density") << soil.name << "." << constant.key;
        }
    }
    EXPECT_EQ(find_soil("sand"), nullptr);
}

TEST(SoilLibrary, IsThatOfThePage)
{
    const std::string text    = text_of(page);
    const auto        heading = text.find(soils_heading);
    ASSERT_NE(heading, std::string::npos);
    const std::string wanted = text.substr(0, heading) + soils_markdown();
    const char*       anew   = std::getenv("TREAD_REGENERATE_DOCS");
    if (anew != nullptr && std::string(anew) == "1") { std::ofstream(page) << wanted; }
    EXPECT_TRUE(text_of(page) == wanted)
        << page << " is out of date; in tests/, run: TREAD_REGENERATE_DOCS=1 PATH_TO_BUILD/bin/unit_scene";
}

TEST(Soil, GivesEveryConstantThatItsModelTakes)
{
    for (const Soil& soil : soils())
    {
        const std::string text = resolved_toml(load_sand(naming(soil)));
        EXPECT_THAT(text, HasSubstr(fmt::format("model = \"{}\"\n", word_of(soil.model))));
        Material material;
        material.model = soil.model;
        for (const auto& key : material_keys())
        {
            const auto value = constant_of(soil, key.text.name);
            if (!value || !key.applies(material)) { continue; }
            EXPECT_THAT(text, HasSubstr(fmt::format("\n{} = {}\n", key.text.name, write_number(*value)))) << soil.name;
        }
    }
}

TEST(Soil, GivesWayToWhatTheSceneWrites)
{
    const Material written = sand("soil = \"GRC-1\"\nrelative_density = 0.5\nyoung = 7e6\nfriction_angle_deg = 33\n");
    EXPECT_EQ(written.young, 7e6);
    EXPECT_EQ(written.friction_angle_deg, 33);
    EXPECT_EQ(written.poisson, 0.3);
    const Material set =
        sand("soil = \"GRC-1\"\nrelative_density = 0.5\n", {"material.sand.young=8e6", "material.sand.soil=Toyoura"});
    EXPECT_EQ(set.young, 8e6);
    EXPECT_EQ(set.void_ratio_max, 0.977);
}

TEST(Soil, RelatesDensityAndRelativeDensityByItsGrains)
{
    // Oravec et al. 2010: grains of 2580 kg/m3 lie at 1600 kg/m3 at the loosest and at 1890 at the densest, which
    // void ratios with three decimals give to 0.2 kg/m3.
    EXPECT_NEAR(sand("soil = \"GRC-1\"\nrelative_density = 0\n").density, 1600, 0.2);
    EXPECT_NEAR(sand("soil = \"GRC-1\"\nrelative_density = 1\n").density, 1890, 0.2);
    EXPECT_NEAR(sand("soil = \"GRC-1\"\ndensity = 1600\n").relative_density, 0, 1e-12);
    EXPECT_EQ(sand("soil = \"GRC-1\"\ndensity = 1890.2\n").relative_density, 1);
    const Material both = sand("soil = \"GRC-1\"\ndensity = 1747\nrelative_density = 0.55\n");
    EXPECT_EQ(both.density, 1747);
    EXPECT_EQ(both.relative_density, 0.55);
    // Void ratios that the scene writes count: e = 2580/1500 - 1 = 0.72 lies in the middle of 0.62 and 0.82.
    const Material own = sand("soil = \"GRC-1\"\nvoid_ratio_min = 0.62\nvoid_ratio_max = 0.82\ndensity = 1500\n");
    EXPECT_NEAR(own.relative_density, 0.5, 1e-12);
}

TEST(Soil, RefusesDensitiesThatContradictEachOtherOrItsPackings)
{
    EXPECT_THAT(
        refusal(with_sand("soil = \"GRC-1\"\ndensity = 1747\nrelative_density = 0.8\n")),
        ContainsRegex("bad.toml:11: \\[material.sand\\] relative_density: 0.8 contradicts density = 1747, which "
                      "is 0.548 of GRC-1; accepted: 0.548, or one of the two left out$"));
    EXPECT_THAT(refusal(with_sand("soil = \"GRC-1\"\ndensity = 1500\n")),
                ContainsRegex("bad.toml:10: \\[material.sand\\] density: 1500 is below the loosest packing of GRC-1; "
                              "accepted: 1600 to 1890.11 \\(kg/m3\\)$"));
    EXPECT_THAT(refusal(with_sand("soil = \"GRC-1\"\ndensity = 1900\n")), HasSubstr("1900 is above the densest"));
    EXPECT_THAT(refusal(with_sand("soil = \"GRC-1\"\n")),
                ContainsRegex("bad.toml:9: \\[material.sand\\] relative_density: missing; GRC-1 may lie loose or "
                              "dense; accepted: number >= 0 and <= 1, or density = 1600 to 1890.11 \\(kg/m3\\)$"));
    for (const char* keys :
         {"density = 1747\nrelative_density = 0.8\n", "density = 1500\n", "", "relative_density = 5\n",
          "relative_density = inf\n", "density = \"loose\"\n", "density = -1.0\n"})
    {
        const std::string message = refusal(with_sand(std::string("soil = \"GRC-1\"\n") + keys));
        EXPECT_THAT(message, HasSubstr("density: "));
        EXPECT_THAT(message, Not(HasSubstr("\n"))) << keys;
    }
}

TEST(Soil, LeavesWhatItLacksToTheScene)
{
    EXPECT_THAT(refusal(with_sand("soil = \"KLS-1\"\n")),
                ContainsRegex("\\[material.sand\\] density: missing; terrain or rocks are made of this"));
}

TEST(Soil, KeepsItsAngleAndDensityToItsOwnModel)
{
    EXPECT_THAT(refusal(with_sand("soil = \"GRC-1\"\nmodel = \"mohr-coulomb\"\ndensity = 1747\n")),
                ContainsRegex("\\[material.sand\\] friction_angle_deg: missing"));
    const Material angle =
        sand("soil = \"GRC-1\"\nmodel = \"mohr-coulomb\"\ndensity = 1747\nfriction_angle_deg = 36\n");
    EXPECT_EQ(angle.model, MaterialModel::mohr_coulomb);
    EXPECT_EQ(angle.friction_angle_deg, 36);
    EXPECT_EQ(angle.void_ratio_max, 0);
    const Material dense =
        sand("soil = \"GRC-3\"\nmodel = \"bolton\"\nfriction_angle_deg = 38\nrelative_density = 1\n");
    EXPECT_NEAR(dense.density, 1940, 0.6); // void ratios have three decimals
}

TEST(Soil, OfAnUnknownNameIsRefusedWithTheNearest)
{
    for (const char* keys : {"soil = \"GRC1\"\n", "soil = \"GRC1\"\nmodel = \"mohr-coulomb\"\n"})
    {
        const std::string message = refusal(with_sand(keys));
        EXPECT_THAT(message, ContainsRegex("bad.toml:9: \\[material.sand\\] soil: unknown word \"GRC1\"; did you mean "
                                           "\"GRC-1\"\\?; accepted: \"GRC-1\" \\| \"GRC-3\" \\| "));
        EXPECT_THAT(message, HasSubstr("\"HIT\""));
        EXPECT_THAT(message, Not(HasSubstr("\n")));
    }
    EXPECT_THAT(refusal(with_sand("soil = 1\n")), HasSubstr("soil: wrong type: an integer"));
}

TEST(Soil, ResolvesToItsValuesAlone)
{
    for (const Soil& soil : soils())
    {
        const Directory   directory;
        const Scene       scene = load_scene(directory.write("scene.toml", with_sand(naming(soil))), {});
        const std::string text  = resolved_toml(scene);
        EXPECT_THAT(text, Not(HasSubstr("soil =")));
        const Scene again = load_scene(directory.write("again.toml", text), {});
        EXPECT_EQ(again, scene) << soil.name;
        EXPECT_EQ(scene_hash(again), scene_hash(scene)) << soil.name;
        EXPECT_TRUE(again.soils.of.empty());
    }
}

TEST(Soil, IsShownInWhatItGave)
{
    const Scene       scene = load_sand("soil = \"GRC-1\"\ndensity = 1747\nyoung = 7e6\n");
    const std::string shown = fmt::format("{}\n", fmt::join(soil_lines(scene), "\n"));
    EXPECT_THAT(shown, HasSubstr("[material.sand] takes 8 values from soil GRC-1:\n"));
    EXPECT_THAT(shown, HasSubstr("  model = \"bolton\" ("));
    EXPECT_THAT(shown, HasSubstr("  poisson = 0.3 (assumed)\n"));
    EXPECT_THAT(shown, ContainsRegex("  relative_density = 0.548[0-9]* \\(density and grains of 2580 kg/m3\\)\n"));
    EXPECT_THAT(shown, Not(HasSubstr("young")));
    EXPECT_TRUE(soil_lines(load_sand("model = \"elastic\"\ndensity = 1\nyoung = 1e6\n")).empty());
}

/// First material of a scene of configs/validation.
Material validated(const std::string& name)
{
    return load_scene(fmt::format("{}scenes/{}", measured, name), {}).materials[0];
}

TEST(Soil, AgreesWithTheScenesOfMeasuredWheels)
{
    const Material spelled = validated("mgru3_density.toml");
    Material       grc_1   = sand("soil = \"GRC-1\"\ndensity = 1747\n");
    std::printf("relative density of GRC-1 at 1747 kg/m3: %.5f, in the scene %.5f, three decimals\n",
                grc_1.relative_density, spelled.relative_density);
    EXPECT_NEAR(grc_1.relative_density, spelled.relative_density, 0.0005);
    grc_1.relative_density = spelled.relative_density;
    EXPECT_EQ(grc_1, spelled);
    EXPECT_EQ(sand("soil = \"GRC-1\"\nmodel = \"mohr-coulomb\"\ndensity = 1747\nfriction_angle_deg = 36\n"),
              validated("mgru3.toml"));
    EXPECT_EQ(sand("soil = \"HIT\"\n"), validated("ding.toml"));
}

TEST(SoilLibrary, HasTheBevameterOfTheMeasuredWheelsOfHIT)
{
    const Node  sets    = parse_document(fmt::format("{}sets.toml", measured));
    const Node* formula = nullptr;
    for (const Node& set : std::get<NodeArray>(find(sets, "set")->value))
    {
        const auto& constants = std::get<NodeArray>(find(set, "bekker")->value);
        if (std::get<std::string>(find(set, "name")->value) == "ding") { formula = &constants.at(0); }
    }
    ASSERT_NE(formula, nullptr);
    const Soil* soil = find_soil("HIT");
    EXPECT_EQ(soil->bevameter.size(), std::get<NodeTable>(formula->value).size());
    for (const SoilConstant& constant : soil->bevameter)
    {
        const Node* value = find(*formula, constant.key);
        ASSERT_NE(value, nullptr) << constant.key;
        EXPECT_EQ(read_number(*value, {}), constant.value) << constant.key;
    }
}

} // namespace
} // namespace tread::scene::test
