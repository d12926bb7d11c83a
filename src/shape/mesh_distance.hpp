#pragma once

#include <array>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "shape/mesh.hpp"
#include "shape/triangle_tree.hpp"

namespace tread::shape
{

/// What the signed distance to a watertight mesh needs. The sign is that of the pseudonormal at the closest face, edge
/// or vertex, the latter weighted by angle (Baerentzen & Aanaes 2005, IEEE TVCG 11:243).
struct MeshDistance
{
    /// By Feature: the face, its three sides, its three corners; directions only, not normalised.
    using Pseudonormals = std::array<Eigen::Vector3d, 7>;

    TriangleTree               tree;
    std::vector<Pseudonormals> pseudonormals; ///< of each triangle
};

MeshDistance prepare_distance(const TriangleMesh& mesh);

/// m, negative inside. `within` (m): an upper bound of the distance, if one is known, saves time.
double signed_distance(const MeshDistance& distance, const Eigen::Vector3d& point,
                       double within = std::numeric_limits<double>::infinity());

} // namespace tread::shape
