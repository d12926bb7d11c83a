#pragma once

#include "shape/mesh.hpp"
#include "shape/winding_number.hpp"

namespace tread::shape
{

/// The part of a surface that bounds the solid: where the winding number is over 1/2 on one side and not on the other.
/// What lies inside, as of parts that overlap, is left out. Triangles that others cross are halved until their pieces
/// are shorter than `finest` (m): to that length the line along which parts meet is jagged.
TriangleMesh find_boundary(const TriangleMesh& mesh, const WindingTree& winding, double finest);

} // namespace tread::shape
