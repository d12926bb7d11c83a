#pragma once

#include "shape/mesh/mesh.hpp"
#include "shape/template.hpp"

namespace tread::shape
{

/// Nodes at the mesh's vertices, each with a third of the area of its triangles: for meshes of near-uniform triangles.
SurfaceNodes nodes_at_vertices(const TriangleMesh& mesh);

/// Places `count` near-uniform nodes on any mesh, corners and sharp edges first, so that edges carry nodes. The two
/// sides of a thin wall have separate nodes.
SurfaceNodes resample_to_count(const TriangleMesh& mesh, int count);

/// Places as many nodes as are `spacing` (m) apart: area / spacing^2. InputError if these are over a million.
SurfaceNodes resample(const TriangleMesh& mesh, double spacing);

} // namespace tread::shape
