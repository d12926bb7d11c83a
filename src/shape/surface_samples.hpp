#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "shape/mesh/mesh.hpp"

namespace tread::shape
{

/// Sharpness of a sample, in the order in which samples receive nodes.
enum class Sharpness
{
    corner, ///< vertex where the number of sharp edges is not two, or the tip of a cone of at most 63 degrees
    edge,   ///< dihedral angle of 40 degrees and more
    smooth
};

/// Points of a surface, denser than its nodes: the candidate positions of nodes, each with its tributary area.
struct SurfaceSamples
{
    std::vector<Eigen::Vector3d> positions;
    std::vector<Eigen::Vector3d> normals;
    std::vector<double>          areas; ///< m2, sum to the surface's
    std::vector<Sharpness>       kinds; ///< corners first, then edges, then the rest
};

/// Samples vertices of a fine mesh at least `apart` (m), corners first, then those of sharp edges. Samples on the two
/// sides of a thin wall are independent.
SurfaceSamples surface_samples(const TriangleMesh& mesh, double apart);

/// Area (m2) of each vertex: a third of its adjacent triangles.
std::vector<double> vertex_areas(const TriangleMesh& mesh);

} // namespace tread::shape
