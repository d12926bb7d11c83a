#include <cmath>

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "dem_scene.hpp"
#include "kernels/dem/sdf_kern.hpp"

namespace tread::test
{
namespace
{

dem::TemplateView view_of(const SolidShape& shape)
{
    dem::TemplateView view{};
    view.sdf_origin  = shape.origin;
    view.sdf_spacing = shape.spacing;
    std::copy(shape.nodes.begin(), shape.nodes.end(), view.sdf_nodes);
    view.sdf_values = shape.values.data();
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

} // namespace
} // namespace tread::test
