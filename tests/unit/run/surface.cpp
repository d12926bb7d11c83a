#include "run/surface.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/random.hpp"
#include "scene_text.hpp"
#include "solver/simulation.hpp"

namespace
{

using namespace tread;
using namespace tread::run;

constexpr double cell = 0.01, spacing = 0.005; // m; eight points per cell

/// 20 by 20 cells.
world::ColumnLattice plan(double width = cell, double bin = cell)
{
    const auto count = static_cast<std::int64_t>(std::lround(0.2 / width));
    return {{count, count}, {width, width}, bin};
}

/// Points of a lattice with spacing `apart` (m) below a height, offset from the cells.
void fill(world::TerrainBins& bins, const std::function<double(double, double)>& height, double apart,
          const Vec3<double>& shift)
{
    for (double x = shift[0] - apart; x < 0.2 + apart; x += apart)
    {
        for (double y = shift[1] - apart; y < 0.2 + apart; y += apart)
        {
            for (double z = shift[2]; z < height(x, y); z += apart) { bins.add_cube({x, y, z}, apart * apart * apart); }
        }
    }
}

/// Checks columns away from the sides, where the lattice ends within a column.
template<class Look>
void for_each_inner(const world::ColumnLattice& lattice, const std::vector<double>& heights, const Look& look)
{
    for (std::int64_t j = 1; j + 1 < lattice.count[1]; ++j)
    {
        for (std::int64_t i = 1; i + 1 < lattice.count[0]; ++i)
        {
            look((static_cast<double>(i) + 0.5) * lattice.width[0], (static_cast<double>(j) + 0.5) * lattice.width[1],
                 heights[static_cast<std::size_t>(i + lattice.count[0] * j)]);
        }
    }
}

double mean_of(const world::ColumnLattice& lattice, const std::vector<double>& heights)
{
    double sum = 0, count = 0;
    for_each_inner(lattice, heights,
                   [&](double, double, double height)
                   {
                       sum += height;
                       ++count;
                   });
    return sum / count;
}

/// The top of a level bed is that of its uppermost points' cubes, for any offset of the lattice from the cells and any
/// spacing of the points.
TEST(Surface, OfALevelBedIsExactForAnyLattice)
{
    Random random(1);
    double worst = 0;
    for (int trial = 0; trial < 30; ++trial)
    {
        const double       apart = spacing * random.uniform(0.6, 1.2);
        const Vec3<double> shift(apart * random.uniform(), apart * random.uniform(), apart * random.uniform(0.5, 1.5));
        world::TerrainBins bins(plan());
        fill(
            bins, [](double, double) { return 0.12; }, apart, shift);
        const double layers = std::ceil((0.12 - shift[2]) / apart), top = shift[2] + (layers - 0.5) * apart;
        for_each_inner(plan(), bins.surface(),
                       [&](double, double, double height) { worst = std::max(worst, std::abs(height - top) / apart); });
    }
    std::cout << "furthest off: " << worst << " point spacings (at most 1e-6: rounding)\n";
    EXPECT_LT(worst, 1e-6);
}

/// Columns give the mean over their own plan: a staircase of points follows a slope to half a point, a cell to less
/// than half a cell times the slope.
TEST(Surface, OfASlopeIsThatUnderEachColumn)
{
    for (const double slope : {0.1, 0.36, 0.7, 1.0})
    {
        const auto         height = [&](double x, double /*y*/) { return 0.08 + slope * x; };
        world::TerrainBins bins(plan());
        fill(bins, height, spacing, {0.3 * spacing, 0.1 * spacing, 0.5 * spacing});
        double worst = 0;
        for_each_inner(plan(), bins.surface(),
                       [&](double x, double y, double found)
                       { worst = std::max(worst, std::abs(found - height(x, y))); });
        std::cout << "slope " << slope << ": furthest off " << worst << " m, half a cell times the slope "
                  << 0.5 * cell * slope << ", half a point " << 0.5 * spacing << "\n";
        EXPECT_LT(worst, 0.5 * cell * slope + 0.5 * spacing); // the lattice's own steps are half a point
    }
}

/// One point in a hundred floats up to 30 mm above the bed: taken from the highest points, the surface would be 29 mm
/// too high.
TEST(Surface, DoesNotStandOnWhatFloats)
{
    const world::ColumnLattice lattice = plan();
    world::TerrainBins         bins(lattice);
    fill(bins, [](double, double) { return 0.2; }, spacing, {0.5 * spacing, 0.5 * spacing, 0.5 * spacing});
    Random    random(7);
    const int floating = 40 * 40 * 40 / 100;
    for (int i = 0; i < floating; ++i)
    {
        bins.add_cube({random.uniform(0, 0.2), random.uniform(0, 0.2), random.uniform(0.2, 0.23)},
                      spacing * spacing * spacing);
    }
    const double found = mean_of(lattice, bins.surface());
    std::cout << "surface " << found << " m, expected 0.2 +- 0.001\n";
    EXPECT_NEAR(found, 0.2, 1e-3);
}

TEST(Surface, OfALonePointIsNone)
{
    world::TerrainBins bins(plan());
    bins.add_cube({0.1, 0.1, 0.1}, spacing * spacing * spacing);
    for (const double height : bins.surface()) { EXPECT_TRUE(std::isnan(height)); }
}

/// Spheres in square layers, columns of two diameters: the surface is the height that the solid of the uppermost layers
/// would reach at the packing of those below, half a gap above their tops.
TEST(Surface, OfABedOfRocksStandsAtTheUppermostLayer)
{
    constexpr double           radius = 0.0095, apart = 0.02;
    const world::ColumnLattice lattice = plan(0.04, 0.01);
    world::TerrainBins         bins(lattice);
    for (int i = 0; i < 10; ++i)
    {
        for (int j = 0; j < 10; ++j)
        {
            for (int k = 0; k < 8; ++k)
            {
                bins.add_sphere({apart * (i + 0.5), apart * (j + 0.5), apart * (k + 0.5)}, radius);
            }
        }
    }
    const double found = mean_of(lattice, bins.surface());
    std::cout << "surface " << found << " m, cells of the lattice end at 0.16, tops of spheres at "
              << 0.16 - 0.5 * apart + radius << "\n";
    EXPECT_NEAR(found, 0.16, 0.1 * apart);
}

/// Rocks in sand with room cut out for them: the surface is as high as that of sand alone.
TEST(Surface, OfAMixtureIsThatOfItsSand)
{
    constexpr double           radius  = 0.01;
    const world::ColumnLattice lattice = plan(0.04, 0.01);
    world::TerrainBins         bins(lattice);
    std::vector<Vec3<double>>  rocks;
    for (int i = 0; i < 5; ++i)
    {
        for (int j = 0; j < 5; ++j)
        {
            for (int k = 0; k < 4; ++k) { rocks.emplace_back(0.04 * (i + 0.5), 0.04 * (j + 0.5), 0.0375 * (k + 0.5)); }
        }
    }
    for (const Vec3<double>& rock : rocks) { bins.add_sphere(rock, radius); }
    constexpr double apart = 0.0025;
    for (double x = 0.5 * apart; x < 0.2; x += apart)
    {
        for (double y = 0.5 * apart; y < 0.2; y += apart)
        {
            for (double z = 0.5 * apart; z < 0.15; z += apart)
            {
                const Vec3<double> place(x, y, z);
                const bool         in_rock =
                    std::any_of(rocks.begin(), rocks.end(),
                                [&](const Vec3<double>& rock) { return (rock - place).norm() < radius; });
                if (!in_rock) { bins.add_cube(place, apart * apart * apart); }
            }
        }
    }
    const double found = mean_of(lattice, bins.surface());
    std::cout << "surface " << found << " m, expected 0.15 +- a point spacing of " << apart << "\n";
    EXPECT_NEAR(found, 0.15, apart);
}

TEST(Surface, WithoutTerrainIsTheFloorOfTheDomain)
{
    std::string text = test::roller_text;
    text.erase(text.find("[[terrain]]"), text.find("[[phase]]") - text.find("[[terrain]]"));
    const scene::Scene scene = test::load_text(text);
    const world::World world = world::build_world(scene);
    Counters           counters;

    solver::Simulation<Cpu, double> simulation(Cpu{&counters}, scene, world, solver::make_plan(scene, world));
    SurfaceMap                      map(scene, world);
    map.renew(simulation.surface_heights(map.lattice()));
    EXPECT_EQ(map.under(0, simulation.named_bodies()[0]), 0);
}

/// A roller in the middle of a bed that rises along x and falls along y.
struct OnASlope
{
    OnASlope()
        : scene(test::load_text(text()))
        , world(world::build_world(scene))
        , simulation(Cpu{&counters}, scene, world, solver::make_plan(scene, world))
        , map(scene, world)
    {
        map.renew(simulation.surface_heights(map.lattice()));
    }

    static std::string text()
    {
        std::string text = test::roller_text;
        text.replace(text.find("region   ="), 0, "height = \"0.2 + 0.2 * (x - 0.2) - 0.1 * (y - 0.2)\"\n");
        text.replace(text.find("[0.4, 0.4, 0.2]]"), 16, "[0.4, 0.4, 0.6]]");
        text.replace(text.find("spacing = 0.05"), 14, "spacing = 0.02");
        return text;
    }

    solver::BodyRow roller_at(double x, double y, double lowest)
    {
        solver::BodyRow row = simulation.named_bodies()[0];
        row.position        = {x, y, lowest + 0.1};
        row.lowest          = lowest;
        return row;
    }

    Counters                        counters;
    scene::Scene                    scene;
    world::World                    world;
    solver::Simulation<Cpu, double> simulation;
    SurfaceMap                      map;
};

/// The local height at the wheel, not the bed's median. Tolerance: half a point spacing, because points lie in steps.
TEST(Surface, UnderAWheelIsThatOfTheSlopeThere)
{
    OnASlope setup;
    for (const double x : {0.12, 0.2, 0.3})
    {
        for (const double y : {0.15, 0.25})
        {
            const double expected = 0.2 + 0.2 * (x - 0.2) - 0.1 * (y - 0.2);
            const double found    = setup.map.under(0, setup.roller_at(x, y, 0.3));
            std::cout << fmt::format("at ({}, {}): surface {:.5f} m, expected {:.5f} +- 0.005\n", x, y, found,
                                     expected);
            EXPECT_NEAR(found, expected, 0.005);
        }
    }
}

/// Lowest point of the roller itself: 0.1 m, its radius over the grousers, which have no height.
TEST(Surface, TheLowestPointOfAWheelIsThatOfItsRim)
{
    OnASlope              setup;
    const solver::BodyRow roller = setup.simulation.named_bodies()[0];
    EXPECT_NEAR(roller.position[2] - roller.lowest, 0.1, 1e-12);
}

/// For a shape that is not a wheel: the lowest point of its mesh, not of its bounding sphere.
TEST(Surface, TheLowestPointOfAShapeIsThatOfItsMesh)
{
    std::string text = test::sand_text + test::rocks_text;
    text.erase(text.find("[[rocks]]"));
    text += R"(
[[body]]
name     = "stone"
shape    = "clast"
material = "rock"
density  = 2700.0
diameter = 0.1
position = [0.2, 0.2, 0.4]
)";
    const scene::Scene scene = test::load_text(text);
    const world::World world = world::build_world(scene);
    Counters           counters;

    solver::Simulation<Cpu, double> simulation(Cpu{&counters}, scene, world, solver::make_plan(scene, world));
    const auto&                     form = world.templates[static_cast<std::size_t>(world.bodies.shape[0])];
    const auto            z = [](const Vec3<double>& one, const Vec3<double>& other) { return one[2] < other[2]; };
    const Vec3<double>    deepest = *std::min_element(form.mesh.vertices.begin(), form.mesh.vertices.end(), z);
    const solver::BodyRow stone   = simulation.named_bodies()[0];
    EXPECT_NEAR(stone.lowest, 0.4 + world.bodies.scale[0] * deepest[2], 1e-12);
    EXPECT_GT(stone.lowest, 0.4 - world.bodies.scale[0] * form.bounding_radius + 1e-3) << "this shape tells them apart";
}

/// Columns on which a body has pressed keep their height; others follow the bed.
TEST(Surface, KeepsItsHeightWhereABodyHasPressed)
{
    OnASlope              setup;
    const solver::BodyRow deep = setup.roller_at(0.1, 0.2, 0.1), above = setup.roller_at(0.3, 0.2, 0.5);
    const double          before = setup.map.under(0, deep);
    setup.map.press({deep});
    setup.map.press({above});
    setup.map.renew(std::vector<double>(static_cast<std::size_t>(setup.map.lattice().size()), 0.05));
    EXPECT_EQ(setup.map.under(0, deep), before);
    EXPECT_NEAR(setup.map.under(0, above), 0.05, 1e-12);
}

} // namespace
