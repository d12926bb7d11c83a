#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "shape/mesh/mesh.hpp"

// Bounding volume hierarchy (axis-aligned boxes) of a mesh's triangles, for exact closest points. Queries may run in
// parallel.
namespace tread::shape
{

struct TriangleTree
{
    struct Node
    {
        Eigen::Vector3d low;
        Eigen::Vector3d high;
        std::int32_t    first; ///< leaf: first entry of corners; else the left child, the right one follows it
        std::int32_t    count; ///< entries of a leaf; 0 = inner node
    };

    std::vector<Node>                           nodes;
    std::vector<std::array<Eigen::Vector3d, 3>> corners;   ///< of the triangles, in the order of the leaves
    std::vector<std::int32_t>                   triangles; ///< their indices in the mesh
};

/// Part of a triangle; side i runs from corner i to the next.
enum class Feature : std::uint8_t
{
    face,
    side_0,
    side_1,
    side_2,
    corner_0,
    corner_1,
    corner_2
};

struct ClosestPoint
{
    Eigen::Vector3d point;
    double          squared_distance; ///< m2
    std::int32_t    triangle;         ///< -1 if there is none within the bound
    Feature         feature;
};

/// Builds the tree. The mesh must have triangles.
TriangleTree build_tree(const TriangleMesh& mesh);

/// Point of the surface closest to `point`, if nearer than `within` (m).
ClosestPoint closest_point(const TriangleTree& tree, const Eigen::Vector3d& point,
                           double within = std::numeric_limits<double>::infinity());

/// Triangles of the mesh whose boxes overlap `box`; at most `most` of them.
std::vector<std::int32_t> triangles_touching(const TriangleTree& tree, const Bounds& box, std::size_t most);

} // namespace tread::shape
