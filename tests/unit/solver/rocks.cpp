#include <algorithm>
#include <cmath>
#include <iostream>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <omp.h>

#include "base/errors.hpp"
#include "scene_text.hpp"
#include "solver/simulation.hpp"
#include "world/bed.hpp"
#include "world/host_points.hpp"
#include "world/rocks.hpp"

namespace
{

using namespace tread;
using namespace tread::solver;
using test::load_text;

/// Rocks of an aspect of 0.55 in a domain without sand; `table` is appended to the [[rocks]] table.
std::string rocks_scene(const std::string& table)
{
    return R"(
[domain]
size    = [0.2, 0.2, 0.1]
gravity = [0.0, 0.0, -9.81]
[grid]
spacing = 0.01
[[material]]
name    = "rock"
model   = "elastic"
density = 2700.0
young   = 1.0e7
[[phase]]
name     = "rest"
duration = 0.01
[[shape]]
name      = "clast"
generate  = { kind = "rock", seed = 3, aspect = 0.55, sphericity = 0.85, nodes = 162 }
sdf_cells = 32
[[rocks]]
shape     = "clast"
material  = "rock"
placement = "rain"
)" + table;
}

/// Smallest distance of a surface node of one body to another body, m, over all pairs.
double nearest_node(const world::World& world)
{
    const world::HostBodies& bodies  = world.bodies;
    double                   nearest = 1;
    for (std::size_t a = 0; a < bodies.size(); ++a)
    {
        const auto& form = world.templates[static_cast<std::size_t>(bodies.shape[a])];
        for (std::size_t b = 0; b < bodies.size(); ++b)
        {
            const auto& other = world.templates[static_cast<std::size_t>(bodies.shape[b])];
            if (a == b || (bodies.position[a] - bodies.position[b]).norm() >
                              bodies.scale[a] * form.bounding_radius + bodies.scale[b] * other.bounding_radius)
            {
                continue;
            }
            const Quat to_other = bodies.orientation[b].conjugate();
            for (const auto& node : form.nodes.positions)
            {
                const Vec3<double> x = bodies.position[a] + bodies.orientation[a] * (bodies.scale[a] * node);
                nearest              = std::min(nearest,
                                                bodies.scale[b] *
                                                    shape::sample(other.sdf, to_other * (x - bodies.position[b]) / bodies.scale[b]));
            }
        }
    }
    return nearest;
}

void expect_inside(const world::World& world, const world::Space& space)
{
    const world::HostBodies& bodies = world.bodies;
    for (std::size_t b = 0; b < bodies.size(); ++b)
    {
        for (const auto& node : world.templates[static_cast<std::size_t>(bodies.shape[b])].nodes.positions)
        {
            ASSERT_TRUE(world::contains(space, bodies.position[b] + bodies.orientation[b] * (bodies.scale[b] * node)));
        }
    }
}

/// The crust of the paper's section 4 needs 23 % solids at an aspect of 0.55, which bounding spheres would not allow:
/// they would fill 0.23 (R_b/R)^3, here more than the 0.38 at which random spheres jam (Torquato 2002, section 12).
TEST(Rocks, IrregularOnesPackDenserThanTheirBoundingSpheres)
{
    const auto         scene = load_text(rocks_scene("solid_fraction = 0.24\ndiameter = 0.012\n"));
    const world::World world = world::build_world(scene);
    const auto         bed   = world::describe_bed(scene, world).rocks.at(0);
    const auto&        form  = world.templates.at(0);
    const double spheres = bed.solid_fraction * std::pow(2 * form.bounding_radius / world::volume_diameter(form), 3);
    std::cout << bed.count << " rocks, solid fraction " << bed.solid_fraction << " (expected 0.24 to half a rock), of "
              << "their bounding spheres " << spheres << "; nearest node " << nearest_node(world) << " m\n";
    EXPECT_NEAR(bed.solid_fraction, 0.24, 0.5 * world::sphere_volume(0.012) / 4e-3);
    EXPECT_GT(spheres, 0.4);
    EXPECT_GE(nearest_node(world), 0.01 * 0.006 * (1 - 1e-9)) << "the clearance that placement promises";
    expect_inside(world, world::rocks_space(scene, 0));
}

TEST(Rocks, GradedOnesNeitherOverlapNorLeaveTheirHill)
{
    const auto scene = load_text(
        rocks_scene("count = 300\ndiameter = { distribution = \"power-law\", exponent = 3, low = 0.006, high = "
                    "0.03 }\nheight = \"0.05 + 0.02*sin(10*pi*x)\"\nfloor = \"0.05*y\"\n"));
    const world::World world = world::build_world(scene);
    const auto         bed   = world::describe_bed(scene, world).rocks.at(0);
    std::cout << "diameters " << bed.smallest_diameter << " to " << bed.largest_diameter << " m, nearest node "
              << nearest_node(world) << " m, at least " << 0.01 * 0.003 << '\n';
    EXPECT_EQ(bed.count, 300);
    EXPECT_GE(bed.smallest_diameter, 0.006);
    EXPECT_LE(bed.largest_diameter, 0.03);
    EXPECT_GE(nearest_node(world), 0.01 * 0.003 * (1 - 1e-9));
    expect_inside(world, world::rocks_space(scene, 0));
}

/// On a lattice as wide as the bounding spheres 0.2 x 0.2 x 0.1 m holds fewer rocks than requested.
TEST(Rocks, LatticesAreNarrowedUntilAllRocksFit)
{
    const auto         text  = rocks_scene("count = 900\ndiameter = 0.012\nplacement = \"grid\"\n");
    const auto         at    = text.find("placement = \"rain\"\n");
    const auto         scene = load_text(std::string(text).erase(at, 19));
    const world::World world = world::build_world(scene);
    const double       width = 2 * world.bodies.scale[0] * world.templates[0].bounding_radius;
    const auto         fits  = [&](double length) { return std::floor(length / width); };
    std::cout << "lattice of bounding spheres: " << fits(0.2) * fits(0.2) * fits(0.1) << " rocks, placed "
              << world.bodies.size() << ", nearest node " << nearest_node(world) << " m\n";
    EXPECT_LT(fits(0.2) * fits(0.2) * fits(0.1), 900);
    EXPECT_GE(nearest_node(world), 0.01 * 0.006 * (1 - 1e-9));
    expect_inside(world, world::rocks_space(scene, 0));
}

/// Points 25 mm apart with a contact radius of 15.5 mm, and 100 rocks of 10 mm, each on a point: of every thirty points
/// under a rock one is removed for the volume of the rocks, the others are pushed aside.
TEST(Rocks, StandWherePointsStood)
{
    std::string text = test::sand_text + test::rocks_text;
    text.replace(text.find("count    = 8\ndiameter = 0.06"), 28,
                 "count = 100\ndiameter = 0.01\nplacement = \"points\"");
    const scene::Scene              plain = load_text(test::sand_text), scene = load_text(text);
    const world::World              sand = world::build_world(plain), world = world::build_world(scene);
    const std::vector<Vec3<double>> sites  = world::make_points(plain, sand, sand.sand.rows).position;
    const std::vector<Vec3<double>> places = world::make_points(scene, world, world.sand.rows).position;
    ASSERT_EQ(world.bodies.size(), 100u);
    EXPECT_EQ(static_cast<double>(sites.size() - places.size()),
              std::round(100 * world::sphere_volume(0.01) / world::largest_volume(sand.sand)));
    for (const Vec3<double>& x : world.bodies.position)
    {
        EXPECT_EQ(std::count(sites.begin(), sites.end(), x), 1);
        EXPECT_EQ(std::count(places.begin(), places.end(), x), 0);
    }
}

/// Sinkage in a scene without sand counts from this height. Two full layers on a lattice as wide as the bounding
/// spheres: the surface is where their solid ends at its own mean packing, which is the top of the lattice, to a bin of
/// half a diameter.
TEST(Rocks, TheirBedIsAsHighAsItsUppermostLayer)
{
    const auto scene_of = [](long count)
    {
        std::string text = rocks_scene(fmt::format("count = {}\ndiameter = 0.012\nplacement = \"grid\"\n", count));
        return load_text(text.erase(text.find("placement = \"rain\"\n"), 19));
    };
    const world::World      alone = world::build_world(scene_of(1));
    const double            width = 2 * alone.bodies.scale[0] * alone.templates[0].bounding_radius;
    const auto              side  = static_cast<long>(std::floor(0.2 / width));
    const auto              scene = scene_of(2 * side * side);
    const world::World      world = world::build_world(scene);
    Counters                counters;
    Simulation<Cpu, double> simulation(Cpu{&counters}, scene, world, make_plan(scene, world));
    double                  highest = 0;
    for (const double height : simulation.surface_heights(world::column_lattice(scene, world)))
    {
        if (!std::isnan(height)) { highest = std::max(highest, height); }
    }
    EXPECT_NEAR(highest, 2 * width, 0.006);
}

TEST(Rocks, AJamSaysHowFullTheRegionIs)
{
    try
    {
        world::build_world(load_text(rocks_scene("solid_fraction = 0.7\ndiameter = 0.03\n")));
        FAIL() << "random rocks cannot fill 0.7";
    }
    catch (const InputError& error)
    {
        const std::string message = error.what();
        EXPECT_NE(message.find("[[rocks]] 0 of shape 'clast': only "), std::string::npos) << message;
        EXPECT_NE(message.find("(solid_fraction = 0.7) fit without overlap"), std::string::npos) << message;
        EXPECT_NE(message.find("a solid fraction of 0."), std::string::npos) << message;
    }
}

TEST(Rocks, DoNotDependOnTheNumberOfThreads)
{
    const auto scene   = load_text(test::sand_text + test::rocks_text);
    const int  threads = omp_get_max_threads();
    omp_set_num_threads(1);
    const world::World one = world::build_world(scene);
    omp_set_num_threads(3);
    const world::World three = world::build_world(scene);
    omp_set_num_threads(threads);
    EXPECT_EQ(one.bodies.position, three.bodies.position);
    EXPECT_EQ(world::make_points(scene, one, one.sand.rows).position,
              world::make_points(scene, three, three.sand.rows).position);
    EXPECT_LT(one.sand.size(), 4u * 8 * 8 * 8 * 8);
}

/// A body with a diameter is scaled: radius and mass follow from it, and no rock touches its surface.
TEST(Rocks, ABodyOfASizeIsScaled)
{
    const auto         scene = load_text(rocks_scene("count = 1\ndiameter = 0.012\n") + R"(
[[body]]
name     = "boulder"
shape    = "clast"
material = "rock"
diameter = 0.04
density  = 3000.0
position = [0.1, 0.1, 0.05]
)");
    const world::World world = world::build_world(scene);
    EXPECT_DOUBLE_EQ(world.bodies.radius.at(0), 0.02);
    EXPECT_NEAR(world.bodies.mass.at(0), 3000 * world::sphere_volume(0.04), 1e-12);
    EXPECT_GT(nearest_node(world), 0);
}

} // namespace
