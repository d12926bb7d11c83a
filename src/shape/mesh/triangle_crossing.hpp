#pragma once

#include "shape/mesh/triangle.hpp"

namespace tread::shape
{

/// Whether two triangles overlap by more than `slack` (m), by separating axes: the normals, cross products of sides,
/// and, for coplanar triangles, the in-plane normals of the sides. Neighbours in a mesh share only their rim.
bool crosses(const Corners& one, const Corners& other, double slack);

/// Whether a triangle lies in another one, in its plane and within its sides, to `slack` (m).
bool lies_within(const Corners& piece, const Corners& other, double slack);

} // namespace tread::shape
