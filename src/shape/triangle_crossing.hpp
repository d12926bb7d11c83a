#pragma once

#include "shape/triangle.hpp"

namespace tread::shape
{

/// Whether two triangles have more than `slack` (m) in common, by separating axes: the normals, products of sides, and,
/// for triangles of one plane, the normals of the sides in it. Neighbours in a mesh have a rim in common, no more.
bool crosses(const Corners& one, const Corners& other, double slack);

} // namespace tread::shape
