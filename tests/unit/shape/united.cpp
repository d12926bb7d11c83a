#include "shape/solids/united.hpp"

#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shape/template.hpp"
#include "unit/shape/meshes.hpp"

namespace tread::shape
{
namespace
{

using ::testing::HasSubstr;

Solid box_solid(const Eigen::Vector3d& low, const Eigen::Vector3d& high)
{
    return make_solid(test::box_mesh(low, high), Repair::none, "box");
}

double area_of(const Solid& solid) { return surface_area(solid.surface); }

TEST(United, BoxesThatOnlyTouchAreOneSolid)
{
    const Solid  solid  = united({box_solid({-1, 0, 0}, {0, 1, 1}), box_solid({0, 0, 0}, {2, 1, 1})}, "bar");
    const double finest = 3.0 / 256;
    EXPECT_NEAR(solid.unit.volume, 3, 1e-12);
    EXPECT_LT((solid.unit.centre - Eigen::Vector3d(0.5, 0.5, 0.5)).norm(), 1e-12);
    EXPECT_NEAR(solid.unit.inertia(0, 0), 3.0 * 2 / 12, 1e-12);
    EXPECT_NEAR(solid.unit.inertia(1, 1), 3.0 * (9 + 1) / 12, 1e-12);
    // The seam is 4 m long, and pieces there are as long as `finest`.
    std::printf("area measured %.6g m2, expected 14, tolerance %.2g: the seam's length times that of its pieces\n",
                area_of(solid), 4 * finest);
    EXPECT_NEAR(area_of(solid), 14, 4 * finest);

    const UnitedDistance distance = prepare_united_distance(solid);
    // Between the parts their own fields are 0; the solid is half a metre deep there.
    for (const double x : {-0.3, -0.01, 0.0, 0.01, 0.4})
    {
        const double depth = -signed_distance(distance, {x, 0.5, 0.5});
        EXPECT_LE(depth, 0.5 + 1e-12) << x;
        EXPECT_GE(depth, 0.5 - finest) << x;
    }
    EXPECT_NEAR(signed_distance(distance, {0, 0.5, 1.25}), 0.25, 1e-12);
    EXPECT_NEAR(signed_distance(distance, {3, 2, 0.5}), std::sqrt(2), 1e-12);
}

TEST(United, OverlapsCountOnce)
{
    const Solid solid = united({box_solid({0, 0, 0}, {1, 1, 1}), box_solid({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5})}, "cubes");
    // The overlap of 1/8 m3 is sampled by cubes of a 128th of it; its faces lie between them.
    std::printf("volume measured %.9g m3, expected 1.875, tolerance 0.1 %% of the overlap\n", solid.unit.volume);
    EXPECT_NEAR(solid.unit.volume, 1.875, 1e-3 * 0.125);
    EXPECT_LT((solid.unit.centre - Eigen::Vector3d::Constant(0.75)).norm(), 1e-4);
    // About x through the centre: two cubes 1/6 + 1/8 each, less that of the overlap, 0.5^5/6.
    EXPECT_NEAR(solid.unit.inertia(0, 0), 2 * (1.0 / 6 + 2 * 0.0625) - std::pow(0.5, 5) / 6, 1e-3 * 0.125);
    // Each cube loses three quarters of a square metre; the seams are 12 half metres.
    EXPECT_NEAR(area_of(solid), 12 - 2 * 0.75, 6 * 1.5 / 256);
}

TEST(United, FlushFacesStayOnce)
{
    const Solid  solid  = united({box_solid({0, 0, 0}, {2, 1, 1}), box_solid({1, 0, 0}, {3, 1, 1})}, "bar");
    const double finest = 3.0 / 256;
    EXPECT_NEAR(solid.unit.volume, 3, 1e-3);
    // Seams at x = 1 and x = 2.
    EXPECT_NEAR(area_of(solid), 14, 8 * finest);
    const UnitedDistance distance = prepare_united_distance(solid);
    EXPECT_NEAR(signed_distance(distance, {1.5, 0.5, 1.1}), 0.1, 1e-12);
    EXPECT_NEAR(signed_distance(distance, {1.5, 0.5, 0.9}), -0.1, 1e-12);
}

/// Bar of 0.4 m along z with a cube of 0.1 m at each end, made of a bar along x and one cube of 0.2 m at half scale.
scene::Scene dumbbell(double cube_at)
{
    scene::Scene scene;
    scene.shapes.push_back({"bar", scene::BoxGenerator{{0.4, 0.02, 0.02}}, std::nullopt, 0.0});
    scene.shapes.push_back({"cube", scene::BoxGenerator{{0.2, 0.2, 0.2}}, std::nullopt, 0.0});
    scene::AssemblyPart bar, high, low;
    bar.shape     = "bar";
    bar.axis      = {0, -2, 0};
    bar.angle_deg = 90;
    high.shape = low.shape = "cube";
    high.scale = low.scale = 0.5;
    high.at                = {0, 0, cube_at};
    low.at                 = {0, 0, -cube_at};
    scene.shapes.push_back({"dumbbell", scene::Assembly{{bar, high, low}}, 120, 0.01});
    return scene;
}

TEST(Assembly, ScalesTurnsAndMovesItsParts)
{
    // Cubes begin where the bar ends.
    const ShapeTemplate form = make_template(find_shape(dumbbell(0.25), "dumbbell"), "");
    const double        bar = 0.4 * 0.02 * 0.02, cube = 1e-3;
    EXPECT_NEAR(form.unit.volume, bar + 2 * cube, 1e-15);
    EXPECT_NEAR(form.unit.inertia(2, 2), bar * 2 * 4e-4 / 12 + 2 * cube * 2 * 0.01 / 12, 1e-15);
    EXPECT_NEAR(form.unit.inertia(0, 0), bar * (0.16 + 4e-4) / 12 + 2 * cube * (2 * 0.01 / 12 + 0.25 * 0.25), 1e-15);
    EXPECT_LT((form.box.extent() - Eigen::Vector3d(0.1, 0.1, 0.6)).norm(), 1e-12);
    std::printf("field's volume %.4f of the solid's, tolerance 2 %%\n", form.sdf_volume_ratio);
    EXPECT_NEAR(form.sdf_volume_ratio, 1, 0.02);
    // Inside the neck, where parts touch: half the bar's width, less the boundary's resolution and half a cell, by
    // which the ridge of the field in the bar's middle is cut off.
    EXPECT_LT(sample(form.sdf, {0, 0, 0.2}), -0.01 + 0.6 / 256 + 0.5 * form.sdf.spacing);
    // Nodes on the outer edges of the cubes, which lie far from where parts meet.
    for (const Eigen::Vector3d& corner : {Eigen::Vector3d(0.05, 0.05, 0.3), Eigen::Vector3d(-0.05, 0.05, -0.3)})
    {
        double nearest = 1;
        for (const auto& node : form.nodes.positions) { nearest = std::min(nearest, (node - corner).norm()); }
        EXPECT_LT(nearest, 1e-12);
    }
}

TEST(Assembly, OfAssembliesIsThatOfAllTheirParts)
{
    scene::Scene        scene = dumbbell(0.2); // cubes overlap the bar by 0.05 m
    scene::AssemblyPart one, two;
    one.shape = two.shape = "dumbbell";
    two.axis              = {1, 0, 0};
    two.angle_deg         = 90;
    scene.shapes.push_back({"cross", scene::Assembly{{one, two}}, 40, 0.02});
    const ShapeTemplate form = make_template(find_shape(scene, "cross"), "");
    const double        bars = 2 * 0.3 * 4e-4 - 8e-6, cubes = 4e-3; // free lengths; the bars share a cube of 0.02 m
    // Overlaps of 5 times 8e-6 and 2e-5 m3 are sampled to some 0.5 %.
    std::printf("volume measured %.6g m3, expected %.6g, tolerance 1e-6\n", form.unit.volume, bars + cubes);
    EXPECT_NEAR(form.unit.volume, bars + cubes, 1e-6);
    EXPECT_NEAR(form.box.extent().y(), 0.5, 1e-12);
    EXPECT_NEAR(form.box.extent().z(), 0.5, 1e-12);
    EXPECT_THAT(form.remarks.back(), HasSubstr("union of 6 solids"));
}

TEST(Assembly, OfPartsThatDoNotMeetIsOneBody)
{
    const ShapeTemplate form = make_template(find_shape(dumbbell(0.5), "dumbbell"), "");
    EXPECT_NEAR(form.unit.volume, 0.4 * 4e-4 + 2e-3, 1e-15);
    EXPECT_NEAR(form.box.extent().z(), 1.1, 1e-12);
}

} // namespace
} // namespace tread::shape
