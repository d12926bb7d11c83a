#pragma once

#include "shape/mesh.hpp"
#include "shape/template.hpp"

namespace tread::shape
{

/// The mesh's vertices, each with a third of its triangles' areas: for meshes of near-uniform triangles.
SurfaceNodes nodes_at_vertices(const TriangleMesh& mesh);

/// `count` near-uniform nodes on any mesh, corners and sharp edges first, so that edges carry nodes. The two sides of a
/// thin wall keep their own nodes.
SurfaceNodes resample_to_count(const TriangleMesh& mesh, int count);

/// The same, as many as are `spacing` (m) apart: area / spacing^2. InputError if that is over a million.
SurfaceNodes resample(const TriangleMesh& mesh, double spacing);

} // namespace tread::shape
