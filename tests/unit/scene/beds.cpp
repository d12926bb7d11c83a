#include <cmath>
#include <locale>
#include <ostream>

#include <gmock/gmock.h>

#include "scene/formula.hpp"
#include "scene/resolved.hpp"
#include "scene_file.hpp"

namespace tread::scene::test
{
namespace beds_test
{

using ::testing::HasSubstr;

const std::string terrain_box = "region = { box = [[0, 0, 0], [1, 1, 0.2]] }";

Scene load_text(const Directory& directory, const std::string& text)
{
    return load_scene(directory.write("scene.toml", text), {});
}

TEST(Beds, every_key_is_written_back)
{
    const Directory directory;
    directory.write("hill.pgm", "P2 2 2 1 0 1 1 0");
    directory.write("hill.csv", "1,2\n3,4\n");
    auto text        = replaced(good_scene, terrain_box + "\npoints_per_cell = 8",
                                "region = { sphere = { centre = [0.5, 0.5, 0.4], radius = 0.2 }, except = [[[0.5, 0.5, 0], "
                                       "[0.6, 0.6, 1]]] }\nheight = \"0.1*sin(2*pi*x) + 0.1\"\nfloor = { file = \"hill.pgm\", low = "
                                       "-0.1, high = 0.05 }\nspacing = 0.0133\nvelocity = [1, 0, -2.5]");
    text             = replaced(text, "count = 5\ndiameter = 0.05\nregion = { box = [[0, 0, 0.1], [1, 1, 0.2]] }",
                                "solid_fraction = 0.2\ndiameter = { distribution = \"power-law\", exponent = 2.5, low = 0.01, "
                                            "high = 0.04 }\nheight = { file = \"hill.csv\", unit = \"mm\", extent = [[0, 0], [1, 2]] }");
    text             = replaced(text, "mass = 10", "mass = 10\ndiameter = 0.4");
    const auto scene = load_text(directory, text);
    EXPECT_EQ(load_text(directory, resolved_toml(scene)), scene) << resolved_toml(scene);

    const Terrain& terrain = scene.terrain[0];
    EXPECT_EQ(terrain.region.sphere, (Sphere{{0.5, 0.5, 0.4}, 0.2}));
    EXPECT_FALSE(terrain.region.box.has_value());
    EXPECT_EQ(terrain.region.except, (std::vector<Box>{{{0.5, 0.5, 0}, {0.6, 0.6, 1}}}));
    EXPECT_EQ(std::get<Formula>(*terrain.height).text, "0.1*sin(2*pi*x) + 0.1");
    EXPECT_EQ(std::get<RasterFile>(*terrain.floor),
              (RasterFile{(directory.path() / "hill.pgm").string(), -0.1, 0.05, 1, PlanExtent{{{0, 0}, {1, 1}}}}));
    EXPECT_EQ(terrain.spacing, 0.0133);
    EXPECT_EQ(terrain.velocity, (Vector3{1, 0, -2.5}));
    const Rocks& rocks = scene.rocks[0];
    EXPECT_EQ(rocks.region.box, (Box{{0, 0, 0}, {1, 1, 1}})) << "the domain, by default";
    EXPECT_EQ(rocks.solid_fraction, 0.2);
    EXPECT_EQ(std::get<PowerLawDiameters>(rocks.diameter), (PowerLawDiameters{2.5, 0.01, 0.04}));
    EXPECT_EQ(std::get<RasterFile>(*rocks.height).unit, 0.001);
    EXPECT_EQ(std::get<RasterFile>(*rocks.height).extent, (PlanExtent{{{0, 0}, {1, 2}}}));
    EXPECT_EQ(scene.bodies[0].diameter, 0.4);
}

TEST(Beds, distributions_are_written_back)
{
    const Directory directory;
    for (const auto* diameter : {"{ distribution = \"uniform\", low = 0.01, high = 0.02 }",
                                 "{ distribution = \"log-normal\", median = 0.02, deviation = 0.3, low = 0.01, high = "
                                 "0.04 }"})
    {
        const auto text  = replaced(good_scene, "diameter = 0.05", std::string("diameter = ") + diameter);
        const auto scene = load_text(directory, text);
        EXPECT_EQ(load_text(directory, resolved_toml(scene)), scene) << diameter;
    }
}

struct BadBed
{
    std::string name;
    std::string from;
    std::string to;
    std::string message; ///< after the file's name
};

std::ostream& operator<<(std::ostream& stream, const BadBed& bad) { return stream << bad.name; }

class BadBeds : public ::testing::TestWithParam<BadBed>
{
};

TEST_P(BadBeds, are_refused_with_line_and_key)
{
    const auto& bad = GetParam();
    EXPECT_THAT(refusal(replaced(good_scene, bad.from, bad.to)), HasSubstr("bad.toml:" + bad.message));
}

const std::string size = "diameter = 0.05";

const std::vector<BadBed> bad_beds{
    {"formula_token", terrain_box, "height = \"0.1*sinus(x)\"", "34: [terrain[0]] height: not a formula at \"sinus\""},
    {"formula_variable", terrain_box, "height = \"0.1*t\"", "34: [terrain[0]] height: not a formula at \"t\""},
    {"formula_ends", terrain_box, "floor = \"0.1*(x\"", "34: [terrain[0]] floor: not a formula"},
    {"formula_empty", terrain_box, "height = \"\"", "34: [terrain[0]] height: not a formula"},
    {"formula_letter", terrain_box, "height = \"x = 3\"",
     "34: [terrain[0]] height: \"=\" has no meaning at character 3; accepted: formula of x and y (m) with + - * / ^ ( "
     ")"},
    {"formula_comma", terrain_box, "height = \"x, 3\"", "34: [terrain[0]] height: a comma outside min() and max()"},
    {"height_type", terrain_box, "height = 3", "34: [terrain[0]] height: wrong type: an integer; accepted: formula"},
    {"raster_missing", terrain_box, "height = { file = \"no.pgm\", low = 0, high = 1 }",
     "34: [terrain[0].height] file: there is no file"},
    {"raster_levels", terrain_box, "height = { file = \"bad.pgm\", low = 0 }",
     "34: [terrain[0].height] high: missing; accepted: number >= -100000 and <= 100000 (m)"},
    {"raster_unit", terrain_box, "height = { file = \"bad.pgm\", low = 0, high = 1, unit = \"mm\" }",
     "34: [terrain[0].height] unit: may stand only with file = \"*.csv\""},
    {"raster_kind", terrain_box, "height = { file = \"bad.toml\" }", "34: [terrain[0]] height: unknown kind of file"},
    {"raster_extent", terrain_box, "height = { file = \"bad.csv\", extent = [[0, 0], [0, 1]] }",
     "34: [terrain[0].height] extent: the extent is empty"},
    {"box_and_sphere", terrain_box,
     "region = { box = [[0, 0, 0], [1, 1, 0.2]], sphere = { centre = [0.5, 0.5, 0.5], radius = 0.1 } }",
     "34: [terrain[0]] region: both box and sphere; accepted: one of box, sphere"},
    {"sphere_outside", terrain_box, "region = { sphere = { centre = [0.5, 0.5, 0.95], radius = 0.1 } }",
     "34: [terrain[0]] region: the sphere leaves the domain along z; accepted: 0 to 1 (m)"},
    {"sphere_radius", terrain_box, "region = { sphere = { centre = [0.5, 0.5, 0.95], radius = 0 } }",
     "34: [terrain[0].region.sphere] radius: 0 is out of range; accepted: number >= 1e-06 and <= 100000 (m)"},
    {"cut_empty", terrain_box, "region = { except = [[[0, 0, 0], [1, 0, 1]]] }",
     "34: [terrain[0].region] except: element 0: the box is empty"},
    {"spacing_and_cells", "points_per_cell = 8", "points_per_cell = 8\nspacing = 0.01",
     "35: [terrain[0]] points_per_cell: may stand only with `from` and `spacing` left out"},
    {"spacing_zero", "points_per_cell = 8", "spacing = 0", "35: [terrain[0]] spacing: 0 is out of range"},
    {"count_and_fraction", "count = 5", "count = 5\nsolid_fraction = 0.2",
     "39: [rocks[0]] count: both count and solid_fraction; accepted: exactly one of count, solid_fraction"},
    {"neither", "count = 5\n", "", "36: [rocks[0]] count: neither count nor solid_fraction"},
    {"fraction_over_one", "count = 5", "solid_fraction = 1.2", "39: [rocks[0]] solid_fraction: 1.2 is out of range"},
    {"distribution_missing", size, "diameter = { low = 0.1, high = 0.2 }",
     "40: [rocks[0].diameter] distribution: missing; accepted: \"uniform\" | \"log-normal\" | \"power-law\""},
    {"distribution_word", size, "diameter = { distribution = \"normal\", low = 0.1, high = 0.2 }",
     "40: [rocks[0].diameter] distribution: unknown word \"normal\""},
    {"distribution_key", size, "diameter = { distribution = \"uniform\", low = 0.1, high = 0.2, median = 1 }",
     "40: [rocks[0].diameter] median: unknown key"},
    {"distribution_order", size, "diameter = { distribution = \"uniform\", low = 0.2, high = 0.1 }",
     "40: [rocks[0]] diameter: low = 0.2 is not below high = 0.1; accepted: low < high"},
    {"distribution_far", size,
     "diameter = { distribution = \"log-normal\", median = 1, deviation = 0.1, low = 0.01, high = 0.02 }",
     "40: [rocks[0]] diameter: a share of 0.0e+00 of this distribution lies between low and high"},
    {"diameter_type", size, "diameter = \"big\"", "40: [rocks[0]] diameter: wrong type: the string"},
    {"body_without_size", "shape = \"perseverance\"", "shape = \"clast\"",
     "43: [body.wheel] diameter: missing; \"clast\" is generated without a size; accepted: number >= 1e-06 and <= "
     "100000 (m)"},
};

std::string case_name(const ::testing::TestParamInfo<BadBed>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Bed, BadBeds, ::testing::ValuesIn(bad_beds), case_name);

TEST(Formula, is_arithmetic_as_written)
{
    const auto at = [](const char* text) { return FormulaEvaluator(text)(0.5, -2); };
    EXPECT_EQ(at("1 + 2*3"), 7);
    EXPECT_EQ(at("-2^2"), -4) << "a sign binds less than a power";
    EXPECT_EQ(at("2^3^2"), 512) << "powers from the right";
    EXPECT_EQ(at("min(x, y, 1) + max(x, y)"), -1.5);
    EXPECT_EQ(at("abs(y)/4"), 0.5);
    EXPECT_EQ(at("log(exp(x))"), 0.5);
    EXPECT_NEAR(at("0.1*sin(2*pi*x + pi/2) + 1e-1"), 0.0, 1e-16);
    EXPECT_TRUE(std::isnan(at("sqrt(y)")));
}

/// The decimal point does not depend on the machine's locale.
TEST(Formula, does_not_follow_the_locale)
{
    struct Comma : std::numpunct<char>
    {
        char do_decimal_point() const override { return ','; }
    };
    const auto before = std::locale::global(std::locale(std::locale::classic(), new Comma));
    EXPECT_EQ(FormulaEvaluator("x + 0.25")(0.5, 0), 0.75);
    std::locale::global(before);
}

} // namespace beds_test
} // namespace tread::scene::test
