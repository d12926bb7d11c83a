#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "shape/mesh/triangle_tree.hpp"

// Winding number of a surface about a point: 1 inside a closed mesh and 0 outside, and in between near the holes of an
// open one (generalized winding number, Jacobson, Kavan & Sorkine-Hornung 2013, ACM TOG 32:33).
namespace tread::shape
{

/// Far-field moments of the triangles of a tree node.
struct Cluster
{
    Eigen::Vector3d area;   ///< m2, sum of the area vectors
    Eigen::Matrix3d moment; ///< m3, sum of area vector times (middle - centre)^T: the remainder where opposite sides of
                            ///< a wall cancel
    Eigen::Vector3d centre; ///< m, weighted by area
    double          radius; ///< m, of a sphere about the centre that encloses the triangles
};

struct WindingTree
{
    TriangleTree         tree;
    std::vector<Cluster> clusters; ///< of each node of the tree
};

WindingTree build_winding_tree(const TriangleMesh& mesh);

/// Winding number at a point. Exact for triangles nearby; a node farther off than four times its radius contributes by
/// its first two moments, as in the fast winding number of Barill et al. 2018, ACM TOG 37:43. Error at most 0.01 for
/// the meshes of the tests.
double winding_number(const WindingTree& winding, const Eigen::Vector3d& point);

/// Mean over both sides of a triangle of the surface, `step` (m) off its middle: 1/2 if it bounds a solid and no other
/// part of the surface is there.
double winding_number_on(const WindingTree& winding, const std::array<Eigen::Vector3d, 3>& triangle, double step);

/// Fraction of the full sphere, -1/2 to 1/2, that a triangle covers seen from the point; positive from the side that
/// its normal points away from (Van Oosterom & Strackee 1983, IEEE Trans. Biomed. Eng. 30:125). 0 in the triangle's
/// plane.
double covered_part(const std::array<Eigen::Vector3d, 3>& corners, const Eigen::Vector3d& point);

} // namespace tread::shape
