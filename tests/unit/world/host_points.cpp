#include <cmath>
#include <iostream>

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "bed_scenes.hpp"

namespace tread::world
{
namespace
{

/// One of three parts, by cubes of 0.08 m as scattered as can be, so that columns are cut at every height.
int part_at(const Vec3<double>& x)
{
    const auto cube = [&](int c) { return static_cast<int>(std::floor(x[c] / 0.08)); };
    return (7 * cube(0) + 5 * cube(1) + cube(2) + 60) % 3;
}

std::vector<PointRow> rows_of(int part, const Sand& sand)
{
    std::vector<PointRow> rows;
    for (const PointRow& row : sand.rows)
    {
        for_each_part(
            row, [&](std::uint32_t k) { return part_at(row.at(k)) == part; },
            [&](const PointRow& run) { rows.push_back(run); });
    }
    return rows;
}

void expect_same(const HostPoints& one, std::size_t i, const HostPoints& other, std::size_t j)
{
    ASSERT_EQ(one.position[i], other.position[j]);
    ASSERT_EQ(one.stress[i], other.stress[j]);
    ASSERT_EQ(one.volume[i], other.volume[j]);
    ASSERT_EQ(one.mass[i], other.mass[j]);
    ASSERT_EQ(one.material[i], other.material[j]);
    ASSERT_EQ(one.terrain[i], other.terrain[j]);
    if (!other.velocity.empty()) { ASSERT_EQ(one.velocity[i], other.velocity[j]); }
    if (!other.plastic_shear.empty()) { ASSERT_EQ(one.plastic_shear[i], other.plastic_shear[j]); }
}

/// Exactly: each point is made from the same numbers in the same order, whatever else is made.
TEST(HostPoints, PartsTogetherAreTheWholeToTheBit)
{
    const test::TemporaryDirectory folder;
    for (const test::BedScene& bed : test::bed_scenes(folder))
    {
        const World      world = build_world(bed.scene);
        const HostPoints all   = make_points(bed.scene, world, world.sand.rows);
        std::size_t      made  = 0;
        for (int part = 0; part < 3; ++part)
        {
            const HostPoints own = make_points(bed.scene, world, rows_of(part, world.sand));
            EXPECT_EQ(own.position.capacity(), own.size()) << "memory of this part only";
            EXPECT_EQ(own.velocity.empty(), all.velocity.empty());
            EXPECT_EQ(own.plastic_shear.empty(), all.plastic_shear.empty());
            for (std::size_t i = 0; i < own.size(); ++i) { expect_same(own, i, all, own.id[i]); }
            EXPECT_GT(own.size(), all.size() / 5);
            made += own.size();
        }
        std::cout << bed.name << ": " << made << " points in three parts, " << all.size() << " in one; "
                  << world.sand.rows.size() << " rows\n";
        EXPECT_EQ(made, all.size());
        EXPECT_EQ(world.sand.size(), all.size());
    }
}

/// The scenes above have what they are to test.
TEST(HostPoints, ScenesOfPartsHaveStressMotionAndStrain)
{
    const test::TemporaryDirectory folder;
    const auto                     scenes = test::bed_scenes(folder);
    const auto                     made   = [&](std::size_t i)
    {
        const World world = build_world(scenes[i].scene);
        return make_points(scenes[i].scene, world, world.sand.rows);
    };
    EXPECT_LT(made(0).stress.front()[2], -100) << "Pa, under 0.2 m of sand";
    EXPECT_FALSE(made(1).velocity.empty());
    EXPECT_LT(made(2).size(), made(0).size()) << "rocks take sand out";
    EXPECT_GT(made(3).plastic_shear.front() + made(3).plastic_shear[1], 0);
    EXPECT_GT(made(4).size(), made(0).size()) << "finer points in the box";
}

/// A bed of rows with gaps, and the same as a list of places.
struct Listed
{
    Sand                      sand;
    std::vector<Vec3<double>> places;
};

Listed listed(Random& random)
{
    Listed all;
    all.sand.kinds = {{1e-6, 1e-3}};
    for (int j = 0; j < 20; ++j)
    {
        const PointRow row{0.5, 0.01, 0.01 * j, 0.2, 3, 30, 0};
        append_where(all.sand, row,
                     [&](std::uint32_t k)
                     {
                         const bool kept = random.uniform() < 0.7;
                         if (kept) { all.places.push_back(row.at(k)); }
                         return kept;
                     });
    }
    return all;
}

void expect_places(const Listed& all)
{
    ASSERT_EQ(all.sand.size(), all.places.size());
    std::size_t next = 0;
    for_each_point(all.sand,
                   [&](const SandPoint& point)
                   {
                       ASSERT_EQ(point.id, next);
                       ASSERT_EQ(point.position, all.places[next++]);
                   });
    for (std::size_t i = 0; i < all.places.size(); ++i) { ASSERT_EQ(point_of(all.sand, i).position, all.places[i]); }
}

TEST(Sand, HasThePointsOfItsRowsInOrder)
{
    Random       random(7);
    const Listed all = listed(random);
    expect_places(all);
    EXPECT_LT(all.sand.rows.size(), all.places.size() / 2);
}

TEST(Sand, LosesAndMovesSinglePoints)
{
    Random                    random(8);
    Listed                    all = listed(random);
    std::vector<PointChange>  changes;
    std::vector<Vec3<double>> places;
    for (std::size_t i = 0; i < all.places.size(); ++i)
    {
        const double       draw = random.uniform();
        const Vec3<double> aside(draw, -draw, 3);
        if (draw < 0.2) { changes.push_back({i, {}}); }
        else if (draw < 0.4) { changes.push_back({i, aside}); }
        if (draw >= 0.2) { places.push_back(draw < 0.4 ? aside : all.places[i]); }
    }
    apply_changes(changes, all.sand);
    all.places = places;
    expect_places(all);
}

/// What every rank has of a bed: a row for each line of points along x, so 1/40 of the points here.
TEST(Sand, ABoxTakesARowForEachLineOfPoints)
{
    const Sand sand = build_world(test::load_text(test::sand_text, {"grid.spacing=0.02"})).sand;
    EXPECT_EQ(sand.size(), 40u * 40 * 20);
    EXPECT_EQ(sand.rows.size(), 40u * 20);
}

} // namespace
} // namespace tread::world
