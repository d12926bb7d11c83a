#pragma once

#include <cstdint>
#include <limits>

#include "shape/mesh/mesh.hpp"
#include "shape/mesh/triangle_tree.hpp"

// Wall thickness of closed surfaces.
namespace tread::shape
{

struct RayHit
{
    double       distance; ///< m; infinite if nothing is hit
    std::int32_t triangle; ///< of the mesh; -1 if nothing is hit
};

/// First triangle, other than `but`, hit by the ray from `origin` along the unit vector `direction` (Moeller & Trumbore
/// 1997, J. Graphics Tools 2:21).
RayHit first_hit(const TriangleTree& tree, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                 std::int32_t but);

/// Thickness (m) of the thinnest wall: length of the chord from a point of the surface along its inward normal to a
/// side within 45 degrees of parallel, so that the sharp edge of a solid does not count. Of 8192 points distributed by
/// area, 2 % may be thinner. Infinite if fewer than that have such a chord.
double thinnest_wall(const TriangleMesh& mesh, const TriangleTree& tree);

} // namespace tread::shape
