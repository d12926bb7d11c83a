#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "shape/distance/sdf_grid.hpp"

namespace tread::shape
{
namespace
{

/// Distance (m) to a box with half sizes 1, 0.7, 0.5: flat faces, edges and corners.
double box_distance(const Eigen::Vector3d& x)
{
    const Eigen::Vector3d q = x.cwiseAbs() - Eigen::Vector3d(1, 0.7, 0.5);
    return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

class SteepestSlope : public testing::TestWithParam<Storage>
{
};

/// No gradient outside exceeds the bound. The bound covers whole cells: for a cell with an edge through it, it includes
/// the inside, where the nearest face changes.
TEST_P(SteepestSlope, BoundsEveryGradientOutside)
{
    const Bounds             box{{-1, -0.7, -0.5}, {1, 0.7, 0.5}};
    const SignedDistanceGrid sdf = build_sdf(
        box, 60, [](const Eigen::Vector3d& x, double) { return box_distance(x); }, 0, GetParam());
    const double bound = steepest_slope(sdf);
    Random       random(11);
    double       found = 0;
    for (int i = 0; i < 200000; ++i)
    {
        const Eigen::Vector3d x(random.uniform(-1.05, 1.05), random.uniform(-0.75, 0.75), random.uniform(-0.55, 0.55));
        if (sample(sdf, x) > 0) { found = std::max(found, sample_gradient(sdf, x).norm()); }
    }
    std::printf("steepest slope %.4f, of 2e5 places %.4f\n", bound, found);
    EXPECT_LE(found, bound + 1e-9);
    EXPECT_GT(found, 1.1) << "an edge makes it steeper than a distance";
    EXPECT_LE(bound, std::sqrt(3.0));
}

TEST_P(SteepestSlope, IsNearlyOneRoundASphere)
{
    const Bounds             box{{-1, -1, -1}, {1, 1, 1}};
    const SignedDistanceGrid sdf = build_sdf(
        box, 60, [](const Eigen::Vector3d& x, double) { return x.norm() - 1; }, 0, GetParam());
    const double bound = steepest_slope(sdf);
    std::printf("steepest slope %.5f\n", bound);
    EXPECT_GE(bound, 1.0);
    EXPECT_LE(bound, 1.0 + sdf.spacing) << "differences of a distance are off by at most h/2R along each axis";
}

INSTANTIATE_TEST_SUITE_P(Storages, SteepestSlope, testing::Values(Storage::dense, Storage::bricks));

} // namespace
} // namespace tread::shape
