#pragma once

#include "shape/mesh.hpp"
#include "shape/template.hpp"

namespace tread::shape
{

/// The mesh's vertices, each with a third of its triangles' areas: for meshes of near-uniform triangles.
SurfaceNodes nodes_at_vertices(const TriangleMesh& mesh);

/// Near-uniform nodes about `spacing` (m) apart on any mesh, corners and sharp edges first, so that edges carry nodes.
/// The two sides of a thin wall keep their own nodes.
SurfaceNodes resample(const TriangleMesh& mesh, double spacing);

} // namespace tread::shape
