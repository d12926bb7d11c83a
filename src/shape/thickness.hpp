#pragma once

#include <cstdint>
#include <limits>

#include "shape/mesh.hpp"
#include "shape/triangle_tree.hpp"

// How thin a closed surface's body is.
namespace tread::shape
{

struct RayHit
{
    double       distance; ///< m; infinite if nothing is hit
    std::int32_t triangle; ///< of the mesh; -1 if nothing is hit
};

/// The first triangle, other than `but`, on the ray from `origin` along the unit vector `direction` (Moeller & Trumbore
/// 1997, J. Graphics Tools 2:21).
RayHit first_hit(const TriangleTree& tree, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                 std::int32_t but);

/// m, thickness of the thinnest wall: the length of the chord that leaves a point of the surface along its inward
/// normal and comes out through a side within 45 degrees of parallel, so that the sharp edge of a solid is no wall. Of
/// 8192 points spread by area, 2 % may be thinner. Infinite where fewer than that have such a chord.
double thinnest_wall(const TriangleMesh& mesh, const TriangleTree& tree);

} // namespace tread::shape
