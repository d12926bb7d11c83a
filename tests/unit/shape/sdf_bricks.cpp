#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>
#include <omp.h>

#include "base/random.hpp"
#include "shape/distance/sdf_grid.hpp"
#include "shape/distance/template_sdf.hpp"
#include "unit/shape/meshes.hpp"

// A grid in bricks compared with the dense one of the same cells, and with the exact distance.
namespace tread::shape
{
namespace
{

using Eigen::Vector3d;

constexpr double radius = 0.26, wall = 0.01, half_width = 0.165;

/// A drum: the rectangle [radius - wall, radius] x [-half_width, half_width] revolved about y. Exact.
double drum_distance(const Vector3d& point, double)
{
    const double around = std::hypot(point.x(), point.z());
    const double across = std::abs(around - (radius - 0.5 * wall)) - 0.5 * wall;
    const double along  = std::abs(point.y()) - half_width;
    return std::hypot(std::max(across, 0.0), std::max(along, 0.0)) + std::min(std::max(across, along), 0.0);
}

const Bounds drum_box{Vector3d(-radius, -half_width, -radius), Vector3d(radius, half_width, radius)};

constexpr double reach = 0.004;

class Bricks : public ::testing::Test
{
protected:
    const SignedDistanceGrid bricks = build_sdf(drum_box, 100, drum_distance, reach, Storage::bricks);
    const SignedDistanceGrid dense  = build_sdf(drum_box, 100, drum_distance, reach, Storage::dense);

    Vector3d anywhere(Random& random) const
    {
        Vector3d in_box;
        for (Eigen::Index a = 0; a < 3; ++a) { in_box[a] = random.uniform(0, 1); }
        const Vector3d extent(dense.nodes[0] - 1, dense.nodes[1] - 1, dense.nodes[2] - 1);
        return dense.origin + dense.spacing * in_box.cwiseProduct(extent);
    }
};

TEST_F(Bricks, AreTheDenseGridNearTheSurface)
{
    Random random(1);
    int    near = 0;
    for (int i = 0; i < 100000; ++i)
    {
        const Vector3d point = anywhere(random);
        if (std::abs(drum_distance(point, 0)) > bricks.fine_reach) { continue; }
        ++near;
        ASSERT_EQ(sample(bricks, point), sample(dense, point));
        ASSERT_EQ(sample_gradient(bricks, point), sample_gradient(dense, point));
    }
    EXPECT_GT(near, 5000);
    EXPECT_GE(bricks.fine_reach, reach + 2 * bricks.spacing);
    EXPECT_TRUE(std::isinf(dense.fine_reach));
}

TEST_F(Bricks, AreOffByNoMoreThanHalfABrickElsewhere)
{
    Random       random(2);
    const double bound = 0.5 * std::sqrt(3.0) * SignedDistanceGrid::brick_cells * bricks.spacing;
    double       worst = 0, worst_dense = 0;
    for (int i = 0; i < 100000; ++i)
    {
        const Vector3d point = anywhere(random);
        const double   exact = drum_distance(point, 0), found = sample(bricks, point);
        worst       = std::max(worst, std::abs(found - exact));
        worst_dense = std::max(worst_dense, std::abs(sample(dense, point) - exact));
        if (std::abs(exact) > bricks.fine_reach) { ASSERT_EQ(found < 0, exact < 0); }
    }
    std::printf("drum, N = 100: off by at most %.2f cells in bricks (proven: %.2f), %.2f cells dense (proven: 0.87)\n",
                worst / bricks.spacing, bound / bricks.spacing, worst_dense / dense.spacing);
    EXPECT_LT(worst, bound);
    EXPECT_LT(worst_dense, 0.5 * std::sqrt(3.0) * dense.spacing);
}

TEST_F(Bricks, AreContinuousWhereFineMeetsCoarse)
{
    Random random(3);
    double worst  = 0;
    int    tested = 0;
    for (int i = 0; i < 100000; ++i)
    {
        Vector3d     point = anywhere(random);
        const auto   axis  = static_cast<Eigen::Index>(i % 3);
        const double edge  = SignedDistanceGrid::brick_cells * bricks.spacing;
        const double face  = std::floor((point[axis] - bricks.origin[axis]) / edge);
        if (face < 1) { continue; }
        point[axis]          = bricks.origin[axis] + face * edge;
        const Vector3d aside = 1e-9 * bricks.spacing * Vector3d::Unit(axis);
        worst                = std::max(worst, std::abs(sample(bricks, point + aside) - sample(bricks, point - aside)));
        ++tested;
    }
    std::printf("jump over %d faces of bricks: measured %.1e m, expected 0, tolerance 1e-7 (float values of 0.1 m)\n",
                tested, worst);
    EXPECT_GT(tested, 80000);
    EXPECT_LT(worst, 1e-7);
}

TEST_F(Bricks, GradientIsThatOfTheInterpolantEverywhere)
{
    Random           random(4);
    constexpr double step   = 1e-7;
    int              tested = 0;
    for (int i = 0; i < 50000; ++i)
    {
        const Vector3d point    = 1.3 * anywhere(random);
        const Vector3d in_cells = (point - bricks.origin) / bricks.spacing;
        const Vector3d rounded  = in_cells.array().round();
        if ((in_cells - rounded).cwiseAbs().minCoeff() < 1e-3) { continue; }
        Vector3d difference;
        for (Eigen::Index axis = 0; axis < 3; ++axis)
        {
            const Vector3d side = step * Vector3d::Unit(axis);
            difference[axis]    = (sample(bricks, point + side) - sample(bricks, point - side)) / (2 * step);
        }
        // Rounding of values of 0.5 m: 1e-16/1e-7 = 1e-9; outside the box the bound's curvature adds step^2/d^2.
        ASSERT_LT((sample_gradient(bricks, point) - difference).norm(), 1e-7) << point.transpose();
        ++tested;
    }
    EXPECT_GT(tested, 40000);
}

TEST_F(Bricks, EncloseTheSameVolume)
{
    const double exact = test::pi * (radius * radius - (radius - wall) * (radius - wall)) * 2 * half_width;
    const double found = enclosed_volume(bricks), expected = enclosed_volume(dense);
    const double alone = enclosed_volume_with(drum_box, 100, drum_distance);
    std::printf("volume over the exact: bricks %.6f, dense %.6f, without a grid %.6f; %.1f and %.1f MB\n",
                found / exact, expected / exact, alone / exact, 1e-6 * static_cast<double>(bricks.bytes()),
                1e-6 * static_cast<double>(dense.bytes()));
    // Cells are the same, the order of sums is not; and the latter has no float rounding (6e-8 of 0.3 m in 5 mm).
    EXPECT_NEAR(found, expected, 1e-12 * expected);
    EXPECT_NEAR(alone, expected, 1e-4 * expected);
    EXPECT_LT(bricks.bytes(), dense.bytes());
}

TEST(SdfStorage, GoesBySize)
{
    const auto grid_of = [](int cells) { return build_sdf(drum_box, cells, drum_distance); };
    EXPECT_TRUE(grid_of(100).slots.empty());
    EXPECT_FALSE(grid_of(160).slots.empty());
}

TEST(SdfStorage, ThreadsDoNotMatter)
{
    const auto mesh = test::ellipsoid(Vector3d(1, 0.7, 0.5), 642);
    const auto source =
        distance_of({"stone", scene::MeshFile{"", 1}, 64, 0.0}, make_solid(mesh, Repair::none, "stone"));
    const int  threads = omp_get_max_threads();
    const auto with    = [&](int count)
    {
        omp_set_num_threads(count);
        return build_sdf(bounds(mesh), 64, source.function, 0, Storage::bricks);
    };
    const SignedDistanceGrid one = with(1), three = with(3);
    omp_set_num_threads(threads);
    EXPECT_EQ(one.values, three.values);
    EXPECT_EQ(one.corners, three.corners);
    EXPECT_EQ(one.slots, three.slots);
}

} // namespace
} // namespace tread::shape
