#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/shape/meshes.hpp"

namespace tread::shape
{
namespace
{

using ::testing::HasSubstr;
using ::testing::Not;

std::string complaint(const TriangleMesh& mesh)
{
    return test::input_error([&] { require_watertight(mesh, "part.stl"); });
}

TEST(Watertight, AcceptsClosedMeshes)
{
    EXPECT_NO_THROW(require_watertight(test::cube(1), "cube"));
    EXPECT_NO_THROW(require_watertight(test::ellipsoid({1, 0.7, 0.5}, 162), "ellipsoid"));
}

TEST(Watertight, CountsOpenEdgesAndNamesTheOrigin)
{
    TriangleMesh mesh = test::cube(1);
    mesh.triangles.pop_back();
    EXPECT_THAT(complaint(mesh), HasSubstr("part.stl"));
    EXPECT_THAT(complaint(mesh), HasSubstr("3 open edges"));
    EXPECT_THAT(complaint(mesh), Not(HasSubstr("orientation")));
    // The first open edge in order of vertices is 1-5, at x = z-middle of the cube's side y = -1/2.
    EXPECT_THAT(complaint(mesh), HasSubstr("(0.5, -0.5, 0) m"));
}

TEST(Watertight, CountsNonManifoldEdges)
{
    TriangleMesh mesh = test::cube(1);
    mesh.triangles.push_back(mesh.triangles.front());
    EXPECT_THAT(complaint(mesh), HasSubstr("3 non-manifold edges"));
}

TEST(Watertight, CountsFlippedEdges)
{
    TriangleMesh mesh = test::cube(1);
    std::swap(mesh.triangles.back()[0], mesh.triangles.back()[1]);
    EXPECT_THAT(complaint(mesh), HasSubstr("3 edges between triangles of opposite orientation"));
}

TEST(Watertight, CountsDegenerateTriangles)
{
    TriangleMesh mesh = test::cube(1);
    mesh.vertices.push_back(0.5 * (mesh.vertices[1] + mesh.vertices[5]));
    mesh.triangles.push_back({1, 5, 8});
    EXPECT_THAT(complaint(mesh), HasSubstr("1 degenerate triangles"));
}

TEST(Watertight, RejectsAMeshThatIsInsideOut)
{
    TriangleMesh mesh = test::cube(1);
    for (auto& triangle : mesh.triangles) { std::swap(triangle[0], triangle[1]); }
    EXPECT_THAT(complaint(mesh), HasSubstr("inside out: its volume is -1 m3"));
}

TEST(Watertight, RejectsAnEmptyMesh) { EXPECT_THAT(complaint({}), HasSubstr("no triangles")); }

} // namespace
} // namespace tread::shape
