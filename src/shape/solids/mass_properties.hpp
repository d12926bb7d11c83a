#pragma once

#include <Eigen/Core>

#include "shape/mesh/mesh.hpp"

namespace tread::shape
{

/// Mass properties of a closed mesh filled with density 1.
struct MassProperties
{
    double          volume;  ///< m3
    Eigen::Vector3d centre;  ///< m, centre of mass
    Eigen::Matrix3d inertia; ///< m5, tensor about the centre of mass, mesh axes
};

/// Computes exact mass properties, by signed tetrahedra (divergence theorem).
MassProperties mass_properties(const TriangleMesh& mesh);

} // namespace tread::shape
