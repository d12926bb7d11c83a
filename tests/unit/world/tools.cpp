#include <cmath>
#include <filesystem>
#include <iostream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "scene_text.hpp"
#include "temporary_directory.hpp"
#include "world/body_grid.hpp"
#include "world/world.hpp"

namespace tread::world
{
namespace
{

/// Sand with a body on it. `shape`: lines of its [[shape]].
std::string standing_text(const std::string& shape)
{
    return fmt::format("{}{}", test::sand_text,
                       fmt::format(R"(
[[material]]
name    = "steel"
model   = "elastic"
density = 7800.0
young   = 1.0e9
poisson = 0.3
[[shape]]
name      = "axle"
generate  = {{ kind = "cylinder", radius = 0.02, length = 0.1 }}
[[shape]]
name         = "tool"
sdf_cells    = 64
node_spacing = 0.008
{}
[[body]]
name     = "tool"
shape    = "tool"
material = "steel"
density  = 7800.0
position = [0.2, 0.2, "on surface"]
gap      = 0.002
)",
                                   shape));
}

/// Each tool as its generator makes it, and its twin from a file of the same mesh.
TEST(FullSizeToolScenes, AreThoseOfTheirTwinsFromFiles)
{
    const test::TemporaryDirectory folder;
    const std::string              path = folder.path("tool.stl");
    for (
        const char* source :
        {R"(generate = { kind = "box", size = [0.1, 0.08, 0.06] })",
         R"(generate = { kind = "plate", radius = 0.06, thickness = 0.012 })",
         R"(generate = { kind = "plate", size = [0.1, 0.12], thickness = 0.012 })",
         R"(generate = { kind = "cylinder", radius = 0.04, length = 0.1 })",
         R"(generate = { kind = "cone", base_radius = 0.02, shaft_radius = 0.015, shaft_length = 0.05 })",
         R"(generate = { kind = "ring", inner_radius = 0.04, outer_radius = 0.07, height = 0.01, vanes = 6, vane_height = 0.01, vane_thickness = 0.008 })",
         R"(generate = { kind = "tube", radius = 0.05, wall_thickness = 0.01, length = 0.06 })",
         R"(generate = { kind = "frame", inner_size = [0.06, 0.08], height = 0.04, wall_thickness = 0.01 })",
         R"(generate = { kind = "frame", inner_size = [0.06, 0.08], height = 0.04, wall_thickness = 0.01, floor_thickness = 0.01 })"})
    {
        const World made = build_world(test::load_text(standing_text(source)));
        const auto& form = made.templates[0];
        shape::write_stl(form.mesh, path);
        const World  twin   = build_world(test::load_text(standing_text(fmt::format("file = \"{}\"", path))));
        const auto&  other  = twin.templates[0];
        const double height = made.bodies.position[0][2];
        std::cout << source << ": " << made.bodies.mass[0] << " kg, centre at " << height << " m\n";
        // Single precision of the file: 6e-8 of 0.1 m on walls of 8 mm.
        EXPECT_NEAR(twin.bodies.mass[0], made.bodies.mass[0], 1e-5 * made.bodies.mass[0]);
        EXPECT_NEAR(twin.bodies.position[0][2], height, 1e-6);
        EXPECT_LT((other.unit.inertia - form.unit.inertia).norm(), 1e-5 * form.unit.inertia.norm());
        for (const Vec3<double>& node : form.nodes.positions)
        {
            ASSERT_NEAR(shape::sample(other.sdf, node), shape::sample(form.sdf, node), 1e-6);
        }
        // It stands on the sand, by its lowest point and the points' radius, and by its gap.
        const double lowest = height + made.bodies.scale[0] * turned_box(made, 0).low[2];
        // A tip goes down between four points.
        EXPECT_GT(lowest, 0.2 - 0.025);
        EXPECT_LT(lowest, 0.2 + 0.0125);
    }
}

TEST(ToolScenes, AnAssemblyIsABodyOfItsParts)
{
    const World world = build_world(test::load_text(standing_text(
        R"(assemble = [ { shape = "axle" }, { shape = "axle", at = [0, 0, 0.05], axis = [1, 0, 0], angle_deg = 90 } ])")));
    // A tee of two cylinders whose axes meet in the end face of the first: each loses what lies in the other, half of
    // Steinmetz's solid of 16/3 r^3.
    const double cylinder = std::acos(-1.0) * 4e-4 * 0.1, shared = 0.5 * 16.0 / 3 * 8e-6;
    const double expected = 7800 * (2 * cylinder - shared);
    std::cout << "mass measured " << world.bodies.mass[0] << " kg, expected " << expected
              << ", tolerance 0.2 %: chords take 0.02 %, and the overlap, 9 % of it all, is sampled to 2 %\n";
    EXPECT_NEAR(world.bodies.mass[0], expected, 2e-3 * expected);
}

} // namespace
} // namespace tread::world
