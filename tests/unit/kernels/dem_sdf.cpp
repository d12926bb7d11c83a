#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "dem_scene.hpp"
#include "kernels/dem/contact/sdf_kern.hpp"
#include "shape/distance/sdf_grid.hpp"

namespace tread::test
{
namespace
{

dem::TemplateView view_of(const SolidShape& shape)
{
    dem::TemplateView view{};
    view.sdf.origin          = shape.origin;
    view.sdf.spacing         = shape.spacing;
    view.sdf.inverse_spacing = 1 / shape.spacing;
    view.sdf.steepest        = std::sqrt(3.0);
    std::copy(shape.nodes.begin(), shape.nodes.end(), view.sdf.nodes);
    view.sdf.values = shape.values.data();
    return view;
}

TEST(Sdf, GradientIsThatOfTheInterpolant)
{
    const SolidShape        shape = unit_sphere(0, 20);
    const dem::TemplateView view  = view_of(shape);
    const Quat              turn(Eigen::AngleAxisd(1.1, Vec3<double>(3, -1, 2).normalized()));
    const Vec3<double>      centre(120.5, -33.25, 7.0);
    constexpr double        scale = 0.37, probe = 1e-5;
    Random                  random(3);
    for (int i = 0; i < 200; ++i)
    {
        // well inside one cell, where the interpolant is smooth: central differences are then exact to rounding
        const auto         inside = [&] { return std::floor(random.uniform(0, 19.9)) + random.uniform(0.1, 0.9); };
        const Vec3<double> local  = shape.origin + shape.spacing * Vec3<double>(inside(), inside(), inside());
        const Vec3<double> x      = centre + turn * (scale * local);
        const auto at = [&](const Vec3<double>& y) { return dem::sample_body_sdf(view, scale, centre, turn, y); };
        const Vec3<double> found = at(x).gradient;
        for (int c = 0; c < 3; ++c)
        {
            const Vec3<double> side  = probe * Vec3<double>::Unit(c);
            const double       slope = (at(x + side).distance - at(x - side).distance) / (2 * probe);
            EXPECT_NEAR(found[c], slope, 1e-5);
        }
        EXPECT_NEAR(at(x).distance, scale * (local.norm() - 1), 0.3 * scale * shape.spacing);
    }
}

TEST(Sdf, IsAPositiveLowerBoundOutsideTheGrid)
{
    const SolidShape        shape = unit_sphere(0, 20);
    const dem::TemplateView view  = view_of(shape);
    Random                  random(4);
    for (int i = 0; i < 200; ++i)
    {
        const Vec3<double> direction(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        const Vec3<double> x     = direction.normalized() * random.uniform(2.2, 5);
        const auto         found = dem::sample_template_sdf(view, x);
        EXPECT_GT(found.distance, 0);
        EXPECT_LT(found.distance, x.norm() - 1 + 1e-6);
        constexpr double probe = 1e-6;
        for (int c = 0; c < 3; ++c)
        {
            const Vec3<double> side  = probe * Vec3<double>::Unit(c);
            const double       slope = (dem::sample_template_sdf(view, x + side).distance -
                                  dem::sample_template_sdf(view, x - side).distance) /
                                 (2 * probe);
            EXPECT_NEAR(found.gradient[c], slope, 1e-5);
        }
    }
}

/// A hollow ball with surfaces of radius 1 and 0.94. Exact.
double shell_distance(const Vec3<double>& x) { return std::abs(x.norm() - 0.97) - 0.03; }

constexpr double point_radius = 0.02;

shape::SignedDistanceGrid shell_in_bricks()
{
    const shape::Bounds box{Vec3<double>::Constant(-1), Vec3<double>::Constant(1)};
    return shape::build_sdf(
        box, 120, [](const Vec3<double>& x, double) { return shell_distance(x); }, point_radius,
        shape::Storage::bricks);
}

dem::TemplateView view_of(const shape::SignedDistanceGrid& sdf)
{
    dem::TemplateView view{};
    view.sdf.origin          = sdf.origin;
    view.sdf.spacing         = sdf.spacing;
    view.sdf.inverse_spacing = 1 / sdf.spacing;
    view.sdf.steepest        = std::sqrt(3.0);
    std::copy(sdf.nodes.begin(), sdf.nodes.end(), view.sdf.nodes);
    std::copy(sdf.bricks.begin(), sdf.bricks.end(), view.sdf.bricks);
    view.sdf.values     = sdf.values.data();
    view.sdf.slots      = sdf.slots.data();
    view.sdf.corners    = sdf.corners.data();
    view.sdf.fine_reach = sdf.fine_reach;
    return view;
}

Vec3<double> point_within(Random& random, double half)
{
    return {random.uniform(-half, half), random.uniform(-half, half), random.uniform(-half, half)};
}

TEST(SdfBricks, AreReadAlikeByKernelsAndHost)
{
    const shape::SignedDistanceGrid sdf  = shell_in_bricks();
    const dem::TemplateView         view = view_of(sdf);
    Random                          random(5);
    for (int i = 0; i < 100000; ++i)
    {
        const Vec3<double> x     = point_within(random, 1.5);
        const auto         found = dem::sample_template_sdf(view, x);
        // The same float values, summed in another order; gradients are differences over a spacing of 0.02.
        ASSERT_NEAR(found.distance, shape::sample(sdf, x), 1e-14);
        ASSERT_LT((found.gradient - shape::sample_gradient(sdf, x)).norm(), 1e-12);
    }
}

TEST(SdfBricks, UncertaintyHoldsAtEveryDistance)
{
    const shape::SignedDistanceGrid sdf  = shell_in_bricks();
    const dem::TemplateView         view = view_of(sdf);
    Random                          random(6);
    double                          near = 0, far = 0;
    for (int i = 0; i < 200000; ++i)
    {
        const Vec3<double> x     = point_within(random, 1.2);
        const double       exact = shell_distance(x);
        const double       error = std::abs(dem::sample_template_sdf(view, x).distance - exact);
        ASSERT_LE(error, dem::sdf_uncertainty(view, 1, exact)) << x.transpose();
        double& worst = exact <= sdf.fine_reach ? near : far;
        worst         = std::max(worst, error);
    }
    std::printf("shell in bricks: off by at most %.2f cells near (proven 0.87), %.2f far (proven 6.93)\n",
                near / sdf.spacing, far / sdf.spacing);
    EXPECT_GT(far, near);
}

/// The search for sand candidates relies on this: no point that it excludes can touch after its displacement.
TEST(SdfBricks, SearchBoundMissesNoContact)
{
    const shape::SignedDistanceGrid sdf  = shell_in_bricks();
    const dem::TemplateView         view = view_of(sdf);
    Random                          random(7);
    int                             touching = 0, left_out = 0;
    for (const double displacement : {0.01, 0.1, 1.0})
    {
        const double bound = dem::search_bound(view, 1, point_radius, displacement);
        for (int i = 0; i < 200000; ++i)
        {
            const Vec3<double> start   = point_within(random, 1.2);
            const Vec3<double> end     = start + 0.5 * displacement * point_within(random, 1).normalized();
            const bool         touches = dem::sample_template_sdf(view, end).distance < point_radius;
            touching += touches ? 1 : 0;
            const bool found = dem::sample_template_sdf(view, start).distance <= bound;
            left_out += found ? 0 : 1;
            ASSERT_TRUE(found || !touches) << start.transpose() << " to " << end.transpose();
        }
    }
    EXPECT_GT(touching, 10000);
    EXPECT_GT(left_out, 10000);
    // If points move by less than the reach of fine cells, bricks add no candidates.
    EXPECT_EQ(dem::search_bound(view, 1, point_radius, 0.005), point_radius + 0.005);
}

} // namespace
} // namespace tread::test
