#pragma once

#include "shape/mesh.hpp"

namespace tread::shape
{

/// The same closed surface in triangles without a side longer than `longest` (m); the old vertices come first.
TriangleMesh refined(const TriangleMesh& mesh, double longest);

} // namespace tread::shape
