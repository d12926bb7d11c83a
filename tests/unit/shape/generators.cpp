#include "shape/generators/generators.hpp"

#include <cmath>
#include <cstddef>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shape/solids/mass_properties.hpp"
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

} // namespace
} // namespace tread::shape
