#pragma once

#include <array>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "shape/distance/winding_number.hpp"
#include "shape/mesh/mesh.hpp"
#include "shape/mesh/triangle_tree.hpp"

namespace tread::shape
{

/// Method that determines the sign of a distance.
enum class SignRule
{
    pseudonormal,   ///< at the closest face, edge or vertex, weighted by angle (Baerentzen & Aanaes 2005, TVCG 11:243)
    winding_number, ///< negative where the winding number exceeds 1/2
    any_part        ///< negative inside any of several solids (united.hpp)
};

/// Precomputed data for signed distances to a mesh.
struct MeshDistance
{
    /// Indexed by Feature: the face, its three sides, its three corners; directions only, not normalised.
    using Pseudonormals = std::array<Eigen::Vector3d, 7>;

    SignRule                   sign;
    TriangleTree               tree;
    std::vector<Pseudonormals> pseudonormals; ///< of each triangle; only with SignRule::pseudonormal
    WindingTree                winding;       ///< only with SignRule::winding_number
};

/// Prepares a watertight mesh whose parts do not meet, with pseudonormals.
MeshDistance prepare_distance(const TriangleMesh& mesh);

/// Prepares the distance to `surface`, negative where the winding number of `parts` exceeds 1/2. `surface` should be
/// the part of `parts` that bounds this region (see boundary.hpp).
MeshDistance prepare_distance(const TriangleMesh& surface, const TriangleMesh& parts);

/// Signed distance (m), negative inside. `within` (m): a known upper bound of its magnitude, which saves time.
double signed_distance(const MeshDistance& distance, const Eigen::Vector3d& point,
                       double within = std::numeric_limits<double>::infinity());

} // namespace tread::shape
