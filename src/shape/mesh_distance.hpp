#pragma once

#include <array>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "shape/mesh.hpp"
#include "shape/triangle_tree.hpp"
#include "shape/winding_number.hpp"

namespace tread::shape
{

/// How inside is told from outside.
enum class SignRule
{
    pseudonormal,  ///< at the closest face, edge or vertex, weighted by angle (Baerentzen & Aanaes 2005, TVCG 11:243)
    winding_number ///< inside is where it is over 1/2
};

/// What the signed distance to a mesh needs.
struct MeshDistance
{
    /// By Feature: the face, its three sides, its three corners; directions only, not normalised.
    using Pseudonormals = std::array<Eigen::Vector3d, 7>;

    SignRule                   sign;
    TriangleTree               tree;
    std::vector<Pseudonormals> pseudonormals; ///< of each triangle; by pseudonormal only
    WindingTree                winding;       ///< by winding number only
};

/// Of a watertight mesh whose parts do not meet, by pseudonormal.
MeshDistance prepare_distance(const TriangleMesh& mesh);

/// Distance to `surface`, inside where `parts` winds round a point more than 1/2 times. `surface` should be the part of
/// `parts` that bounds that inside (see boundary.hpp).
MeshDistance prepare_distance(const TriangleMesh& surface, const TriangleMesh& parts);

/// m, negative inside. `within` (m): an upper bound of the distance, if one is known, saves time.
double signed_distance(const MeshDistance& distance, const Eigen::Vector3d& point,
                       double within = std::numeric_limits<double>::infinity());

} // namespace tread::shape
