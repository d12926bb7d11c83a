#include "shape/hull_depth.hpp"

#include <gtest/gtest.h>

#include "meshes.hpp"
#include "shape/template.hpp"

namespace tread::test
{
namespace
{

TEST(HullDepth, ConvexBodiesHaveNone)
{
    const shape::TriangleMesh box = cube(1), ball = ellipsoid({1, 0.8, 0.6}, 162);
    EXPECT_NEAR(shape::hull_depth(box, box.vertices), 0, 1e-14);
    EXPECT_NEAR(shape::hull_depth(ball, ball.vertices), 0, 1e-14);
}

/// A box with a pit: the hull is the box, and the pit's floor lies below its lid.
TEST(HullDepth, OfAPitIsItsDepth)
{
    const shape::TriangleMesh box = cube(1);
    EXPECT_NEAR(shape::hull_depth(box, {{0.5, 0, 0}, {0, 0, 0.3}, {0.1, 0, 0.4}}), 0.2, 1e-14);
}

/// The distinction of solver/bodies/device_templates.cpp: wheels with grousers, and rocks that nearly fill their hulls.
TEST(FullSizeHullDepth, DistinguishesWheelsFromRocks)
{
    for (const std::string& name : shape::builtin_shape_names())
    {
        scene::Shape wheel              = shape::find_shape(scene::Scene{}, name);
        wheel.sdf_cells                 = 40; // the field is not used here
        const shape::ShapeTemplate form = shape::make_template(wheel, "");
        EXPECT_GT(form.hull_depth, 0.05 * form.equivalent_radius) << name;
    }
    for (std::uint64_t seed = 1; seed < 5; ++seed)
    {
        scene::Shape shape;
        shape.name                      = "clast";
        shape.source                    = scene::RockGenerator{seed};
        const shape::ShapeTemplate form = shape::make_template(shape, "");
        EXPECT_LT(form.hull_depth, 0.05 * form.equivalent_radius) << seed;
    }
}

} // namespace
} // namespace tread::test
