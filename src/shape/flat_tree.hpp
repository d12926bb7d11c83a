#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "shape/mesh/triangle.hpp"
#include "shape/mesh/triangle_tree.hpp"

// Template data for ray queries.
namespace tread::shape
{

/// A TriangleTree in depth-first order, traversed without a stack.
struct FlatTree
{
    struct Box
    {
        std::array<float, 3> low;  ///< m; a millionth of the mesh's extent beyond the triangles
        std::array<float, 3> high; ///< m
        std::int32_t         next; ///< next node outside this one's subtree
        std::int32_t         leaf; ///< 8 first + count of its triangles; 0 = inner node
    };

    std::vector<Box>     boxes;
    std::vector<Corners> triangles; ///< in the order of the leaves
};

FlatTree flatten(const TriangleTree& tree);

/// Outward unit normal of a closed mesh at the surface point closest to each point. On edges and vertices it is the
/// mean over the adjacent triangles, weighted by their angle (Baerentzen & Aanaes 2005, TVCG 11:243).
std::vector<Eigen::Vector3d> surface_normals(const TriangleMesh& mesh, const TriangleTree& tree,
                                             const std::vector<Eigen::Vector3d>& points);

} // namespace tread::shape
