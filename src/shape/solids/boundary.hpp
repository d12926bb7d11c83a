#pragma once

#include "shape/distance/winding_number.hpp"
#include "shape/mesh/mesh.hpp"

namespace tread::shape
{

/// Extracts the part of a surface that bounds the solid: where the winding number exceeds 1/2 on one side and not on
/// the other. Surface inside the solid, as of overlapping parts, is dropped. Triangles that others cross are bisected
/// until their pieces are shorter than `finest` (m), so the line along which parts meet is jagged at that length.
TriangleMesh find_boundary(const TriangleMesh& mesh, const WindingTree& winding, double finest);

} // namespace tread::shape
