#include "shape/template.hpp"

#include <cstdio>
#include <filesystem>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/shape/meshes.hpp"

namespace tread::shape
{
namespace
{

using ::testing::HasSubstr;

double total(const std::vector<double>& areas) { return std::accumulate(areas.begin(), areas.end(), 0.0); }

TEST(Template, OfAFileIsRecentredAndScaled)
{
    const std::string folder = ::testing::TempDir();
    const auto        box    = test::box_mesh({100, 200, 300}, {300, 300, 350});
    write_stl(box, (std::filesystem::path(folder) / "template_box.stl").string());
    const ShapeTemplate made = make_template({"box", scene::MeshFile{"template_box.stl", 1e-3}, 40, 0.0}, folder);

    EXPECT_LT((made.mesh_centre - Eigen::Vector3d(0.2, 0.25, 0.325)).norm(), 1e-12);
    EXPECT_LT((made.box.low + made.box.high).norm(), 1e-12);
    EXPECT_EQ(made.unit.centre.norm(), 0);
    EXPECT_NEAR(made.unit.volume, 1e-3, 1e-15);
    EXPECT_NEAR(made.unit.inertia(0, 0), 1e-3 * (0.1 * 0.1 + 0.05 * 0.05) / 12, 1e-15);
    EXPECT_NEAR(made.bounding_radius, 0.5 * std::hypot(0.2, 0.1, 0.05), 1e-12);
    EXPECT_NEAR(made.equivalent_radius, std::cbrt(3e-3 / (4 * test::pi)), 1e-12);
    EXPECT_FALSE(made.is_wheel);
    EXPECT_NEAR(total(made.nodes.areas), 2 * (0.02 + 0.005 + 0.01), 1e-12);
    // Flats are refined by halves and thinned from there: up to a quarter off.
    EXPECT_NEAR(made.nodes.spacing, 0.2 / 40, 0.25 * 0.2 / 40);
    // On the middle of the side x = 0.1, a plane, float node values are all the error.
    EXPECT_NEAR(sample(made.sdf, {0.1, 0, 0}), 0, 1e-8);
    EXPECT_NEAR(sample(made.sdf, {0.09, 0, 0}), -0.01, 1e-8);
    std::filesystem::remove(std::filesystem::path(folder) / "template_box.stl");
}

TEST(Template, OfARockIsCentredOnItsMass)
{
    const ShapeTemplate made  = make_template({"clast", scene::RockGenerator{7, 0.55, 0.90, 162}, 64, 0.0}, "");
    const auto          again = mass_properties(made.mesh);
    EXPECT_LT(again.centre.norm(), 1e-14);
    EXPECT_NEAR(made.unit.volume, test::pi / 6, 1e-12);
    EXPECT_NEAR(made.equivalent_radius, 0.5, 1e-12);
    EXPECT_EQ(made.nodes.positions.size(), 162u);
    std::printf("rock: SDF volume ratio %.4f, expected 1, tolerance 1 %%\n", made.sdf_volume_ratio);
    // Second order in the spacing: less than 1 % at 40 cells already.
    EXPECT_NEAR(made.sdf_volume_ratio, 1, 0.01);
    for (const auto& node : made.nodes.positions)
    {
        // Vertices stick out of the trilinear interpolant by less than half a cell.
        EXPECT_LT(std::abs(sample(made.sdf, node)), 0.5 * made.sdf.spacing);
    }
}

TEST(Template, OfASphereIsTheExactSphere)
{
    const ShapeTemplate made = make_template({"ball", scene::SphereGenerator{162}, 64, 0.0}, "");
    EXPECT_DOUBLE_EQ(made.unit.volume, test::pi / 6);
    EXPECT_DOUBLE_EQ(made.unit.inertia(2, 2), 0.4 * test::pi / 6 * 0.25);
    EXPECT_NEAR(made.equivalent_radius, 0.5, 1e-15);
    EXPECT_NEAR(made.bounding_radius, 0.5, 1e-12);
    EXPECT_NEAR(total(made.nodes.areas), test::pi, 1e-12);
    for (const auto& node : made.nodes.positions) { EXPECT_NEAR(node.norm(), 0.5, 1e-12); }
    for (int i = 0; i < 100; ++i)
    {
        // Between vertices too: spacing^2/(4 R) = 1.8e-4 is the interpolation's bound.
        EXPECT_NEAR(sample(made.sdf, 0.5 * test::sphere_point(i, 100)), 0, 1.8e-4);
    }
}

TEST(Template, BuiltinWheelsKeepTheirVolumeInTheSdf)
{
    for (const std::string& name : builtin_shape_names())
    {
        const ShapeTemplate made = make_template(find_shape(scene::Scene{}, name), "");
        std::printf("%s: %d x %d x %d SDF nodes (%.1f MB), volume ratio %.4f (expected 1, tolerance 1 %%), %zu surface "
                    "nodes %.4g m apart\n",
                    name.c_str(), made.sdf.nodes[0], made.sdf.nodes[1], made.sdf.nodes[2],
                    4e-6 * static_cast<double>(made.sdf.values.size()), made.sdf_volume_ratio,
                    made.nodes.positions.size(), made.nodes.spacing);
        // The solver warns beyond 2 %; presets stay well within.
        EXPECT_NEAR(made.sdf_volume_ratio, 1, 0.01);
        EXPECT_TRUE(made.is_wheel);
        EXPECT_EQ(made.equivalent_radius, made.wheel.radius);
        EXPECT_GE(made.bounding_radius, made.wheel.radius);
    }
}

TEST(Template, TooCoarseAnSdfShowsInItsVolume)
{
    scene::Shape shape = find_shape(scene::Scene{}, "perseverance");
    shape.sdf_cells    = 40;
    // A spacing of 16 mm on walls of 10 mm: most of the wheel is lost between the nodes.
    EXPECT_LT(make_template(shape, "").sdf_volume_ratio, 0.8);
}

TEST(Template, FindShapePrefersTheSceneAndListsWhatItKnows)
{
    scene::Scene scene;
    scene.shapes.push_back({"ball", scene::SphereGenerator{}, 32, 0.0});
    scene.shapes.push_back({"spirit", scene::SphereGenerator{}, 32, 0.0});
    EXPECT_EQ(find_shape(scene, "ball").sdf_cells.value(), 32);
    EXPECT_TRUE(std::holds_alternative<scene::SphereGenerator>(find_shape(scene, "spirit").source));
    EXPECT_TRUE(std::holds_alternative<scene::WheelGenerator>(find_shape(scene, "viper").source));
    EXPECT_THAT(test::input_error([&] { find_shape(scene, "bal"); }),
                HasSubstr("shape 'bal' is unknown; known are ball, spirit, perseverance"));
}

TEST(Template, NamesTheFileThatIsWrong)
{
    EXPECT_THAT(test::input_error(
                    [] {
                        make_template({"clast", scene::MeshFile{"no.stl", 1}, 64, 0.0}, "/nowhere");
                    }),
                HasSubstr("/nowhere/no.stl"));
}

} // namespace
} // namespace tread::shape
