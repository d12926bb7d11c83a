#include <cmath>
#include <cstdlib>
#include <limits>

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "kernels/mpm/grid/levels.hpp"
#include "kernels/mpm/transfers/stencil_kern.hpp"

namespace mpm_levels_test
{

using namespace tread;
using namespace tread::mpm;

constexpr double spacing = 0.1;

const Lattice scene_lattice = make_lattice(spacing, 0.5);

/// Weight of a node along x at a position, from the stencil of its level.
double weight_at(int level, std::int32_t node, double x)
{
    const Lattice         lattice = level_lattice(scene_lattice, level);
    const Vec3<double>    at(x, 0.3, 0.3);
    const Index3          cell    = cell_of(at, lattice);
    const Stencil<double> stencil = stencil_above<double>(cell, at, lattice.inverse_spacing, lattice);
    const std::int32_t    n       = node - cell.x;
    return n < 0 || n > 2 ? 0 : stencil.weight[0][n];
}

TEST(Levels, PlacesFarAwayHaveCellsOutside)
{
    const double nowhere           = std::numeric_limits<double>::quiet_NaN();
    const Index3 far               = cell_of({1.5e9, 1e300, -1e300}, scene_lattice),
                 lost              = cell_of({nowhere, 0.3, 0.3}, scene_lattice);
    constexpr std::int32_t outside = 1 << 29;
    EXPECT_EQ(far.x, outside);
    EXPECT_EQ(far.y, outside);
    EXPECT_EQ(far.z, -outside);
    EXPECT_EQ(std::abs(lost.x), outside);
    EXPECT_EQ(lost.y, 2);
}

TEST(Levels, ACellIsTwoOfTheNextLevel)
{
    Random random(1);
    for (int trial = 0; trial < 10000; ++trial)
    {
        const Vec3<double> at(random.uniform(-0.5, 5), random.uniform(-0.5, 5), random.uniform(-0.5, 5));
        for (int level = 0; level < most_levels; ++level)
        {
            const Index3 coarse =
                shifted_by(cell_of(at, level_lattice(scene_lattice, level)), -level_offset(level) * page_edge);
            const Index3 fine =
                shifted_by(cell_of(at, level_lattice(scene_lattice, level + 1)), -level_offset(level + 1) * page_edge);
            EXPECT_EQ(fine.x >> 1, coarse.x);
            EXPECT_EQ(fine.y >> 1, coarse.y);
            EXPECT_EQ(fine.z >> 1, coarse.z);
        }
    }
}

/// N_i = (n_2i-2 + 3 n_2i-1 + 3 n_2i + n_2i+1) / 4, at random positions.
TEST(Levels, ASplineIsASumOfSplinesOfTheNextLevel)
{
    Random random(2);
    double worst = 0;
    for (int trial = 0; trial < 10000; ++trial)
    {
        const double x = random.uniform(0, 3);
        for (int level = 0; level < most_levels; ++level)
        {
            const std::int32_t from = level_offset(level) * page_edge, to = level_offset(level + 1) * page_edge;
            const Lattice      lattice = level_lattice(scene_lattice, level);
            const std::int32_t node =
                cell_of({x, 0.3, 0.3}, lattice).x + static_cast<std::int32_t>(random.uniform(0, 3));
            const std::int32_t first = 2 * (node - from) - 2 + to;
            const double       sum = 0.25 * weight_at(level + 1, first, x) + 0.75 * weight_at(level + 1, first + 1, x) +
                               0.75 * weight_at(level + 1, first + 2, x) + 0.25 * weight_at(level + 1, first + 3, x);
            worst = std::max(worst, std::abs(sum - weight_at(level, node, x)));
        }
    }
    std::cout << "largest difference " << worst << ", tolerance 1e-13 (rounding)\n";
    EXPECT_LT(worst, 1e-13);
}

TEST(Levels, KeysAscendByLevel)
{
    for (int level = 0; level < most_levels; ++level)
    {
        const std::int32_t from = level_offset(level), to = level_offset(level + 1);
        EXPECT_LT(page_key({from + 60000, from + 60000, from + 60000}), page_key({to - 2, to - 2, to - 2}));
        EXPECT_EQ(level_of({to - 2, to + 5, to}), level + 1);
        EXPECT_EQ(level_of({from + 60000, from, from}), level);
    }
    EXPECT_EQ(level_of({-3, 5, 5}), 0);
}

TEST(Levels, APositionBelongsToTheFinestBoxAroundIt)
{
    Refinement         refinement;
    const std::int32_t one = level_offset(1) * page_edge, two = level_offset(2) * page_edge;
    refinement.levels = 2;
    refinement.box[0] = {{one + 20, one + 20, one + 20}, {one + 60, one + 60, one + 60}};
    refinement.box[1] = {{two + 60, two + 60, two + 60}, {two + 100, two + 100, two + 100}};
    const auto level  = [&](double x) { return level_of(page_of(finest_cell(scene_lattice, refinement, {x, x, x}))); };
    // Knots of level 1 are multiples of 0.05, its box is [21, 61) of them; that of level 2 is [62, 102) of 0.025.
    EXPECT_EQ(level(1.049), 0);
    EXPECT_EQ(level(1.051), 1);
    EXPECT_EQ(level(1.549), 1);
    EXPECT_EQ(level(1.551), 2);
    EXPECT_EQ(level(2.549), 2);
    EXPECT_EQ(level(2.551), 1);
    EXPECT_EQ(level(3.051), 0);
    const CellBox replaced = replaced_cells(refinement, 0);
    EXPECT_EQ(replaced.low.x, 10);
    EXPECT_EQ(replaced.high.x, 30);
    EXPECT_EQ(replaced_cells(refinement, 1).low.x, one + 30);
    EXPECT_FALSE(replaced_cells(refinement, 2).contains({two + 70, two + 70, two + 70}));
}

} // namespace mpm_levels_test
