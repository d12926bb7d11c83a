#include <random>

#include <gtest/gtest.h>

#include "scene_text.hpp"
#include "world/body_grid.hpp"
#include "world/reached_cells.hpp"

// The quick test before a search for bodies: it may only say no where the search finds nothing.
namespace tread::world
{
namespace
{

/// Eight rocks of 6 cm.
World eight_rocks()
{
    return build_world(test::load_text(test::sand_text + test::rocks_text + "placement = \"replace\"\n"));
}

bool is_near(const BodyGrid& grid, const Vec3<double>& x, double reach)
{
    return grid.any_near(x, reach, [](std::size_t) { return true; });
}

TEST(ReachedCells, MissesNothingAndRulesOutMost)
{
    const World world = eight_rocks();
    BodyGrid    grid(world);
    for (std::size_t body = 0; body < world.bodies.size(); ++body) { grid.add(body); }
    std::mt19937_64                        random(1);
    std::uniform_real_distribution<double> place(-0.1, 0.6);
    for (const double reach : {0.0, 0.004, 0.05})
    {
        const ReachedCells cells(world, reach);
        int                near = 0, maybe = 0;
        for (int i = 0; i < 100'000; ++i)
        {
            const Vec3<double> x{place(random), place(random), place(random)};
            const bool         found = is_near(grid, x, reach), may_be = cells.may_be_near(x);
            ASSERT_LE(found, may_be) << x.transpose() << ", reach " << reach;
            near += found ? 1 : 0;
            maybe += may_be ? 1 : 0;
        }
        ASSERT_GT(near, 100);
        // Eight cells as wide as the sphere, the most that its box overlaps, have 15.3 times its volume.
        EXPECT_LT(maybe, 16 * near) << "reach " << reach;
    }
}

TEST(ReachedCells, ThePointOfASphereThatIsFarthestOutIsNear)
{
    const World        world = eight_rocks();
    const ReachedCells cells(world, 0.01);
    for (std::size_t body = 0; body < world.bodies.size(); ++body)
    {
        for (int c = 0; c < 3; ++c)
        {
            for (const double side : {-1.0, 1.0})
            {
                const Vec3<double> way = side * (bounding_radius(world, body) + 0.01) * Vec3<double>::Unit(c);
                EXPECT_TRUE(cells.may_be_near(world.bodies.position[body] + way)) << body << ", axis " << c;
            }
        }
    }
}

TEST(ReachedCells, NothingIsNearWhereThereAreNoBodies)
{
    const ReachedCells cells(build_world(test::load_text(test::sand_text)), 1.0);
    EXPECT_FALSE(cells.may_be_near({0.1, 0.1, 0.1}));
}

} // namespace
} // namespace tread::world
