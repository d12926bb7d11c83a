#include <algorithm>
#include <cmath>
#include <iostream>
#include <numeric>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <omp.h>

#include "base/errors.hpp"
#include "scene_text.hpp"
#include "world/bed.hpp"
#include "world/cover.hpp"
#include "world/grading.hpp"
#include "world/host_points.hpp"
#include "world/layers.hpp"
#include "world/make_room.hpp"

// Room for rocks in sand: mass is conserved to a point, nothing touches, and no void is left.
namespace
{

using namespace tread;
using namespace tread::world;
using test::load_text;

/// 23 % of rocks of 5 cm among points 12.5 mm apart, in the upper 10 cm of the bed; `table` is appended to the
/// [[rocks]] table.
std::string filled(const std::string& table, const std::string& grid = "spacing = 0.025")
{
    std::string text = test::sand_text + test::rocks_text;
    text.replace(text.find("count    = 8\ndiameter = 0.06"), 28, "solid_fraction = 0.23\ndiameter = 0.05");
    text.replace(text.rfind("[0.0, 0.0, 0.02]"), 16, "[0.0, 0.0, 0.10]");
    text.replace(text.find("spacing = 0.05"), 14, grid);
    return text + table;
}

double volume_of(const World& world)
{
    double sum = 0;
    for_each_point(world.sand, [&](const SandPoint& point) { sum += point.kind.volume; });
    return sum;
}

double rock_volume(const World& world)
{
    double sum = 0;
    for (const double radius : world.bodies.radius) { sum += sphere_volume(2 * radius); }
    return sum;
}

std::int64_t touching(const scene::Scene& scene, const World& world)
{
    const auto covered = covered_points(scene, world);
    return std::accumulate(covered.begin(), covered.end(), std::int64_t{0});
}

/// A rock removes its own volume of points: the last point is whole, so the error is half a point, plus the points
/// without a place.
void expect_room(const std::string& text, int without_place)
{
    const auto   scene = load_text(text);
    const World  world = build_world(scene);
    std::string  plain = text;
    const double sand  = volume_of(build_world(load_text(plain.erase(plain.find("[[rocks]]")))));
    const double taken = sand - volume_of(world), point = largest_volume(world.sand);
    const double off = (0.5 + without_place) * point * (1 + 1e-9);
    std::cout << world.bodies.size() << " rocks of " << rock_volume(world) << " m3 take the place of " << taken
              << " m3 of sand, tolerance " << 0.5 + without_place << " points, " << off << " m3; void "
              << world.layers.at(0).empty() << '\n';
    EXPECT_NEAR(taken, rock_volume(world), off);
    EXPECT_NEAR(world.layers.at(0).empty(), 0, off / world.layers.at(0).space + 1e-9);
    EXPECT_EQ(touching(scene, world), 0);
    for (const Vec3<double>& x : make_points(scene, world, world.sand.rows).position)
    {
        ASSERT_TRUE(x.minCoeff() > 0 && x[0] < 0.4 && x[1] < 0.4 && x[2] < 0.2) << "out of the bed: " << x.transpose();
    }
}

TEST(MakeRoom, RocksTakeTheirOwnVolumeOfSand) { expect_room(filled(""), 0); }

/// Nine samples per point do not fit into every neck between rocks: of 14 500 points one finds no place.
TEST(MakeRoom, PointsThatTakeSamplesAreClearAsWell) { expect_room(filled("[numerics]\nrefine_below = 4.0\n"), 2); }

TEST(MakeRoom, RocksAtPointsTakeTheirOwnVolumeOfSand)
{
    std::string text = filled("placement = \"points\"\n");
    expect_room(text.replace(text.find("solid_fraction = 0.23"), 21, "solid_fraction = 0.1"), 0);
}

/// Half of a lattice of rocks lies above the surface of the sand.
TEST(MakeRoom, OnlyWhatStandsInSandCounts)
{
    std::string text = filled("");
    text.replace(text.rfind("[0.0, 0.0, 0.10], [0.4, 0.4, 0.2]"), 33, "[0.0, 0.0, 0.10], [0.4, 0.4, 0.3]");
    text.replace(text.find("solid_fraction = 0.23"), 21, "solid_fraction = 0.1");
    const auto   scene = load_text(text);
    const World  world = build_world(scene);
    std::string  plain = text;
    const double taken = volume_of(build_world(load_text(plain.erase(plain.find("[[rocks]]"))))) - volume_of(world);
    const double share = taken / rock_volume(world);
    std::cout << "sand taken over rocks placed " << share
              << ", expected 0.5 within 0.2: three deviations of 49 random places\n";
    EXPECT_NEAR(share, 0.5, 0.2);
    EXPECT_NEAR(world.layers.at(0).empty(), 0, 1e-2) << "of the half that sand stood in";
    EXPECT_EQ(touching(scene, world), 0);
}

TEST(MakeRoom, DoesNotDependOnTheNumberOfThreads)
{
    const auto scene   = load_text(filled(""));
    const int  threads = omp_get_max_threads();
    omp_set_num_threads(1);
    const World one = build_world(scene);
    omp_set_num_threads(3);
    const World three = build_world(scene);
    omp_set_num_threads(threads);
    const HostPoints points = make_points(scene, one, one.sand.rows), same = make_points(scene, three, three.sand.rows);
    EXPECT_EQ(points.position, same.position);
    EXPECT_EQ(points.stress, same.stress);
}

/// Points 25 mm apart keep 15.5 mm from rocks of 6 mm radius: there is hardly any place left.
std::string crowded(const std::string& table)
{
    std::string text = filled(table, "spacing = 0.05");
    return text.replace(text.find("diameter = 0.05"), 15, "diameter = 0.012");
}

TEST(MakeRoom, VoidsAreRefusedWithWhatWouldDo)
{
    try
    {
        build_world(load_text(crowded("")));
        FAIL() << "there is no room for the sand";
    }
    catch (const InputError& error)
    {
        const std::string message = error.what();
        std::cout << message << '\n';
        for (const char* part : {"scene.toml:", "[[rocks]] 0 of shape 'clast'", "% sand", "% rock", "% void",
                                 "at most 5 % void", "[[terrain]] spacing", "allow_voids = true"})
        {
            EXPECT_NE(message.find(part), std::string::npos) << part;
        }
    }
}

TEST(MakeRoom, VoidsThatAreAllowedAreCounted)
{
    const auto  scene = load_text(crowded("allow_voids = true\n"));
    const World world = build_world(scene);
    const auto& layer = world.layers.at(0);
    const auto  bed   = describe_bed(scene, world);
    EXPECT_GT(layer.empty(), most_void);
    EXPECT_NEAR(layer.rock, 0.23, 1e-3);
    EXPECT_NEAR(layer.sand, (volume_of(world) - 0.016) / 0.016, 1e-6) << "what is left of the upper 0.016 m3";
    EXPECT_EQ(bed.layers.at(0).empty, layer.empty());
    EXPECT_EQ(touching(scene, world), 0);
    ASSERT_EQ(layer_advice(scene, world).size(), 1u);
    EXPECT_NE(layer_advice(scene, world)[0].find("contact radii"), std::string::npos);
}

TEST(MakeRoom, LargeRocksNeedNoAdvice)
{
    const auto scene = load_text(filled(""));
    EXPECT_TRUE(layer_advice(scene, build_world(scene)).empty());
}

/// Finer points in the layer of the rocks stay there: the bed below keeps every point in place.
TEST(MakeRoom, PointsStayInTheSandOfTheirTable)
{
    std::string text = filled("");
    text.replace(text.find("[[phase]]"), 9,
                 "[[terrain]]\nmaterial = \"sand\"\nspacing = 0.00625\nregion = { box = [[0.0, 0.0, 0.1], [0.4, 0.4, "
                 "0.2]] }\n[[phase]]");
    const World world = build_world(load_text(text));
    std::size_t fine  = 0;
    for_each_point(world.sand,
                   [&](const SandPoint& point)
                   {
                       fine += point.kind.terrain == 1 ? 1 : 0;
                       ASSERT_EQ(point.kind.terrain == 1, point.position[2] >= 0.1);
                   });
    EXPECT_GT(fine, 40000u);
}

} // namespace
