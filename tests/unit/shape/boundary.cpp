#include "shape/solids/boundary.hpp"

#include <gtest/gtest.h>

#include "shape/distance/winding_number.hpp"
#include "shape/mesh/triangle.hpp"
#include "unit/shape/awkward_meshes.hpp"

namespace
{

using namespace tread;

// A cube and, within it, a pillar from its floor to its roof: the pillar's ends lie in the cube's faces. That makes 60
// pieces, as the pillar's edges lie where faces are bisected; 262,184 where pieces are bisected under a face that
// covers them. The bound allows 24 pieces for each `finest` of edge.
TEST(Boundary, OnlyAlongEdgesAreCoplanarFacesBisected)
{
    constexpr double finest = 1.0 / 256, edges = 4, area = 6, most_pieces = 24 * edges / finest;
    const auto       mesh =
        test::together(test::box_mesh({0, 0, 0}, {1, 1, 1}), test::box_mesh({0.25, 0.25, 0}, {0.75, 0.75, 1}));
    const auto boundary = shape::find_boundary(mesh, shape::build_winding_tree(mesh), finest);
    RecordProperty("pieces", static_cast<int>(boundary.triangles.size()));
    EXPECT_LT(static_cast<double>(boundary.triangles.size()), most_pieces);
    // Faces that coincide are kept twice: both bound the solid.
    const double kept = shape::surface_area(boundary);
    EXPECT_NEAR(kept, area + 2 * 0.25, 4 * edges * finest);
}

} // namespace
