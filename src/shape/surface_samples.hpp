#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "shape/mesh.hpp"

namespace tread::shape
{

/// In the order in which they are given nodes.
enum class Sharpness
{
    corner, ///< where other than two sharp edges meet
    edge,   ///< of 40 degrees and more
    smooth
};

/// Points of a surface, closer than its nodes will be: the places that a node may take, each with the area about it.
struct SurfaceSamples
{
    std::vector<Eigen::Vector3d> positions;
    std::vector<Eigen::Vector3d> normals;
    std::vector<double>          areas; ///< m2, sum to the surface's
    std::vector<Sharpness>       kinds; ///< corners first, then edges, then the rest
};

/// Vertices of a fine mesh at least `apart` (m), corners first, then those of sharp edges. The two sides of a thin wall
/// do not see each other.
SurfaceSamples surface_samples(const TriangleMesh& mesh, double apart);

/// m2, a third of the triangles round each vertex.
std::vector<double> vertex_areas(const TriangleMesh& mesh);

} // namespace tread::shape
