#include "shape/template.hpp"

#include <cstdio>
#include <filesystem>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shape/distance/sdf_report.hpp"
#include "unit/shape/meshes.hpp"

namespace tread::shape
{
namespace template_test
{

using ::testing::HasSubstr;

double total(const std::vector<double>& areas) { return std::accumulate(areas.begin(), areas.end(), 0.0); }

TEST(Template, OfAFileIsRecentredAndScaled)
{
    const std::string folder = ::testing::TempDir();
    const auto        box    = test::box_mesh({100, 200, 300}, {300, 300, 350});
    write_stl(box, (std::filesystem::path(folder) / "template_box.stl").string());
    const ShapeTemplate made =
        make_template({"box", scene::MeshFile{"template_box.stl", 1e-3, false}, 40, 0.0}, folder);

    EXPECT_LT((made.mesh_centre - Eigen::Vector3d(0.2, 0.25, 0.325)).norm(), 1e-12);
    EXPECT_LT((made.box.low + made.box.high).norm(), 1e-12);
    EXPECT_EQ(made.unit.centre.norm(), 0);
    EXPECT_NEAR(made.unit.volume, 1e-3, 1e-15);
    EXPECT_NEAR(made.unit.inertia(0, 0), 1e-3 * (0.1 * 0.1 + 0.05 * 0.05) / 12, 1e-15);
    EXPECT_NEAR(made.bounding_radius, 0.5 * std::hypot(0.2, 0.1, 0.05), 1e-12);
    EXPECT_NEAR(made.equivalent_radius, std::cbrt(3e-3 / (4 * test::pi)), 1e-12);
    EXPECT_FALSE(made.is_wheel);
    EXPECT_NEAR(total(made.nodes.areas), 2 * (0.02 + 0.005 + 0.01), 1e-12);
    // Flat faces are refined by bisection and thinned from there: the spacing is up to a quarter off.
    EXPECT_NEAR(made.nodes.spacing, 0.2 / 40, 0.25 * 0.2 / 40);
    // In the middle of the side x = 0.1, a plane, rounding of float node values is the only error.
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
        // Vertices are outside the trilinear interpolant by less than half a cell.
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
        // Between vertices too: spacing^2/(4 R) = 1.8e-4 bounds the interpolation error.
        EXPECT_NEAR(sample(made.sdf, 0.5 * test::sphere_point(i, 100)), 0, 1.8e-4);
    }
}

TEST(Template, NodesOfASphereFollowTheSpacingThatIsAskedFor)
{
    const double        spacing = 0.05;
    const ShapeTemplate made    = make_template({"ball", scene::SphereGenerator{642}, 40, spacing}, "");
    const double        wanted  = test::pi / (spacing * spacing);
    const auto          count   = static_cast<double>(made.nodes.positions.size());
    std::printf("%g nodes (expected %g, tolerance 20 %%: spacing is \"about\")\n", count, wanted);
    EXPECT_NEAR(count / wanted, 1, 0.2);
    EXPECT_NEAR(total(made.nodes.areas), test::pi, 1e-12);
    for (std::size_t i = 0; i < made.nodes.positions.size(); ++i)
    {
        const std::size_t part = i / SurfaceNodes::part_size;
        const auto&       node = made.nodes.positions[i];
        EXPECT_NEAR(node.norm(), 0.5, 1e-12);
        EXPECT_LE((node - made.nodes.part_centres[part]).norm(), made.nodes.part_radii[part] + 1e-12);
    }
}

TEST(FullSizeTemplate, BuiltinWheelsKeepTheirVolumeInTheSdf)
{
    for (const std::string& name : builtin_shape_names())
    {
        const ShapeTemplate made = make_template(find_shape(scene::Scene{}, name), "");
        std::printf("%s: %d x %d x %d SDF nodes (%.1f MB), volume ratio %.4f (expected 1, tolerance 1 %%), %zu surface "
                    "nodes %.4g m apart\n",
                    name.c_str(), made.sdf.nodes[0], made.sdf.nodes[1], made.sdf.nodes[2],
                    1e-6 * static_cast<double>(made.sdf.bytes()), made.sdf_volume_ratio, made.nodes.positions.size(),
                    made.nodes.spacing);
        // The solver warns beyond 2 %; built-in wheels stay well within.
        EXPECT_NEAR(made.sdf_volume_ratio, 1, 0.01);
        EXPECT_TRUE(made.is_wheel);
        EXPECT_EQ(made.equivalent_radius, made.wheel.radius);
        EXPECT_GE(made.bounding_radius, made.wheel.radius);
    }
}

TEST(Template, TooCoarseAnSdfShowsInItsVolumeAndSaysWhatWouldDo)
{
    scene::Shape shape{"drum", scene::WheelGenerator{0.26, 0.33, 0.02, 0, 0, 0.004}, 20, 0.03};
    // A spacing of 31 mm on walls of 20 mm: most of the wheel is lost between the nodes.
    const ShapeTemplate coarse = make_template(shape, "");
    EXPECT_LT(coarse.sdf_volume_ratio, 0.8);
    ASSERT_EQ(coarse.warnings.size(), 1u);
    std::printf("%s\n", coarse.warnings.front().c_str());

    int enough = 0;
    EXPECT_THAT(coarse.warnings.front(), HasSubstr("its SDF of sdf_cells = 20 encloses"));
    const std::size_t at = coarse.warnings.front().find("; sdf_cells = ");
    ASSERT_NE(at, std::string::npos);
    ASSERT_EQ(std::sscanf(coarse.warnings.front().c_str() + at, "; sdf_cells = %d would", &enough), 1);
    shape.sdf_cells          = enough;
    const ShapeTemplate fine = make_template(shape, "");
    EXPECT_NEAR(fine.sdf_volume_ratio, 1, 0.02);
    EXPECT_TRUE(fine.warnings.empty());
}

TEST(Template, CellsFollowTheThinnestWall)
{
    const auto cells = [](const scene::ShapeSource& source) {
        return make_template({"shape", source, std::nullopt, 0.03}, "").sdf_cells;
    };
    // 1.2 x 0.52 x 1.5 over the wall; chords between facets are up to 2 % short.
    EXPECT_NEAR(cells(scene::WheelGenerator{0.26, 0.33, 0.02, 0, 0, 0.004}), 47, 1);
    EXPECT_NEAR(cells(scene::WheelGenerator{0.26, 0.33, 0.012, 48, 0.0125, 0.008}), 117, 1);
    EXPECT_EQ(cells(scene::RockGenerator{7, 0.55, 0.90, 162}), 40);
    EXPECT_EQ(cells(scene::SphereGenerator{2562}), 40);
}

TEST(Template, WallsTooThinForAnyGridAreRemarkedOn)
{
    const ShapeTemplate sheet =
        make_template({"sheet", scene::WheelGenerator{0.26, 0.02, 0.001, 0, 0, 0.004}, std::nullopt, 0.02}, "");
    EXPECT_EQ(sheet.sdf_cells, 512);
    ASSERT_FALSE(sheet.warnings.empty());
    std::printf("%s\n", sheet.warnings.front().c_str());
    EXPECT_THAT(sheet.warnings.front(), HasSubstr("it has 512, the most that \"auto\" takes"));
}

TEST(Template, ConvergesWithItsCells)
{
    const scene::Shape shape{"clast", scene::RockGenerator{7, 0.55, 0.90, 162}, std::nullopt, 0.0};
    const auto qualities = sdf_convergence(make_measured_template(shape, "", [](double) { return 0.0; }), {20, 40, 80});
    for (const SdfQuality& q : qualities)
    {
        std::printf("rock, N = %d: mean |phi| %.2e of the extent, volume ratio %.4f, mean normal error %.2f degrees\n",
                    q.cells, q.mean_surface, q.volume_ratio, q.mean_normal);
    }
    // Facets of 0.1 m per side: errors occur at the ridges between them. The affected part of the surface decreases
    // with the spacing, as does the error there: second order, 4 per halving, and first order, 2, for the normals. A
    // third off, because cells grow over whole facets.
    for (std::size_t i = 1; i < qualities.size(); ++i)
    {
        EXPECT_NEAR(qualities[i - 1].mean_surface / qualities[i].mean_surface, 4, 1.4);
        EXPECT_NEAR(qualities[i - 1].mean_normal / qualities[i].mean_normal, 2, 0.7);
        EXPECT_LT(std::abs(qualities[i].volume_ratio - 1), std::abs(qualities[i - 1].volume_ratio - 1));
    }
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
                HasSubstr("shape 'bal' is unknown; did you mean \"ball\"?; known are ball, spirit, perseverance"));
}

TEST(Template, OfABrokenFileNeedsRepair)
{
    const std::string folder = ::testing::TempDir();
    TriangleMesh      box    = test::box_mesh({0, 0, 0}, {2, 1, 1});
    box.triangles.pop_back();
    write_stl(box, (std::filesystem::path(folder) / "broken_box.stl").string());
    EXPECT_THAT(test::input_error(
                    [&] {
                        make_template({"box", scene::MeshFile{"broken_box.stl", 1, false}, 16, 0.0}, folder);
                    }),
                testing::AllOf(HasSubstr("shape 'box', file"), HasSubstr("broken_box.stl"), HasSubstr("3 open edges"),
                               HasSubstr("repair = true")));
    const ShapeTemplate made = make_template({"box", scene::MeshFile{"broken_box.stl", 1, true}, 16, 0.0}, folder);
    EXPECT_NEAR(made.unit.volume, 2, 1e-12);
    EXPECT_EQ(made.sign, SignRule::pseudonormal);
    EXPECT_THAT(made.remarks, testing::Contains("repair: 1 holes closed by 1 triangles"));
    std::filesystem::remove(std::filesystem::path(folder) / "broken_box.stl");
}

TEST(Template, OfOverlappingPartsIsTheirUnion)
{
    const std::string folder = ::testing::TempDir();
    TriangleMesh      two    = test::box_mesh({0, 0, 0}, {2, 1, 1});
    for (const auto& t : test::cube(1).triangles) { two.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8}); }
    for (const auto& v : test::box_mesh({1, 0.25, 0.25}, {3, 0.75, 0.75}).vertices) { two.vertices.push_back(v); }
    write_stl(two, (std::filesystem::path(folder) / "overlap.stl").string());
    const ShapeTemplate made = make_template({"peg", scene::MeshFile{"overlap.stl", 1, false}, 64, 0.0}, folder);
    std::filesystem::remove(std::filesystem::path(folder) / "overlap.stl");
    EXPECT_EQ(made.sign, SignRule::winding_number);
    EXPECT_NEAR(made.unit.volume, 2.25, 2.25e-3);
    // 2 x 1 x 1 has an area of 10, the peg adds its four sides of 1 x 1/2. The rim is jagged to pieces of 3/256.
    const double rim = 2.0 * 3 / 256;
    std::printf("area: measured %.4f, expected 12, tolerance %.4f\n", total(made.nodes.areas), rim);
    EXPECT_NEAR(total(made.nodes.areas), 12, rim);
    EXPECT_NEAR(made.sdf_volume_ratio, 1, 0.02);
    // The end of the peg in the middle of the box is not surface: the box's side is 1/2 away.
    EXPECT_NEAR(sample(made.sdf, Eigen::Vector3d(1, 0.5, 0.5) - made.mesh_centre), -0.5, made.sdf.spacing);
}

TEST(Template, NamesTheFileThatIsWrong)
{
    EXPECT_THAT(test::input_error(
                    [] {
                        make_template({"clast", scene::MeshFile{"no.stl", 1, false}, 64, 0.0}, "/nowhere");
                    }),
                HasSubstr("/nowhere/no.stl"));
}

} // namespace template_test
} // namespace tread::shape
