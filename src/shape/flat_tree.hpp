#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "shape/triangle.hpp"
#include "shape/triangle_tree.hpp"

// What rays against a template need of it.
namespace tread::shape
{

/// A TriangleTree depth first, to be walked without a stack.
struct FlatTree
{
    struct Box
    {
        std::array<float, 3> low;  ///< m; a millionth of the mesh's extent beyond the triangles
        std::array<float, 3> high; ///< m
        std::int32_t         next; ///< the first node that is not inside this one
        std::int32_t         leaf; ///< 8 first + count of its triangles; 0 = it holds boxes
    };

    std::vector<Box>     boxes;
    std::vector<Corners> triangles; ///< in the order of the leaves
};

FlatTree flatten(const TriangleTree& tree);

/// Outward unit normal of a closed mesh at the place of its surface closest to each point: on sides and corners those
/// of the triangles that meet there, weighted by their angle (Baerentzen & Aanaes 2005, TVCG 11:243).
std::vector<Eigen::Vector3d> surface_normals(const TriangleMesh& mesh, const TriangleTree& tree,
                                             const std::vector<Eigen::Vector3d>& points);

} // namespace tread::shape
