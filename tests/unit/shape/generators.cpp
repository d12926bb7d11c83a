#include "shape/generators.hpp"

#include <cmath>
#include <cstddef>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shape/form.hpp"
#include "shape/mass_properties.hpp"
#include "unit/shape/meshes.hpp"

namespace tread::shape
{
namespace
{

using ::testing::HasSubstr;

TEST(Icosphere, HasItsVerticesOnTheSphere)
{
    for (const int nodes : {42, 162, 642, 2562})
    {
        const TriangleMesh mesh = icosphere(nodes, "sphere");
        EXPECT_EQ(mesh.vertices.size(), static_cast<std::size_t>(nodes));
        EXPECT_NO_THROW(require_watertight(mesh, "sphere"));
        for (const auto& vertex : mesh.vertices) { EXPECT_NEAR(vertex.norm(), 1, 1e-15); }
    }
    EXPECT_THAT(test::input_error([] { icosphere(100, "shape 'x'"); }), HasSubstr("shape 'x': nodes = 100"));
}

TEST(Rock, MeetsItsAspectSphericityAndVolume)
{
    for (std::uint64_t seed = 0; seed < 40; ++seed)
    {
        for (const int nodes : {42, 162, 642})
        {
            const TriangleMesh mesh = rock_mesh({seed, 0.75, 0.90, nodes}, "rock");
            ASSERT_NO_THROW(require_watertight(mesh, "rock"));
            ASSERT_NEAR(sphericity(mesh), 0.90, 0.03 * 0.90) << "seed " << seed << ", " << nodes << " nodes";
            ASSERT_NEAR(mass_properties(mesh).volume, test::pi / 6, 1e-12);
            const Eigen::Vector3d extent = bounds(mesh).extent();
            ASSERT_NEAR(extent.z() / extent.x(), 0.75, 1e-12);
            ASSERT_NEAR(extent.y() / extent.x(), 0.875, 1e-12);
        }
    }
}

TEST(Rock, IsTheSameForTheSameSeedAndAnotherForAnother)
{
    const TriangleMesh one = rock_mesh({7, 0.55, 0.90, 162}, "rock"), again = rock_mesh({7, 0.55, 0.90, 162}, "rock"),
                       other = rock_mesh({8, 0.55, 0.90, 162}, "rock");
    EXPECT_EQ(one.vertices, again.vertices);
    double most = 0;
    for (std::size_t i = 0; i < one.vertices.size(); ++i)
    {
        most = std::max(most, (one.vertices[i] - other.vertices[i]).norm());
    }
    EXPECT_GT(most, 0.02);
}

TEST(Rock, SaysWhatSphericityCanBeReached)
{
    const std::string message = test::input_error([] { rock_mesh({1, 0.4, 0.99, 162}, "shape 'flat'"); });
    EXPECT_THAT(message, HasSubstr("shape 'flat': sphericity = 0.99"));
    // That of the ellipsoid 1 : 0.7 : 0.4 with 162 nodes.
    EXPECT_THAT(message, HasSubstr("to 0.889 can be reached"));
    test::input_error([] { rock_mesh({1, 0.1, 0.9, 162}, "rock"); });
    test::input_error([] { rock_mesh({1, 0.5, 1.1, 162}, "rock"); });
    test::input_error([] { rock_mesh({1, 0.5, 0.9, 100}, "rock"); });
}

} // namespace
} // namespace tread::shape
