#pragma once

#include "shape/mesh/mesh.hpp"

namespace tread::shape
{

/// Refines a closed surface until no side is longer than `longest` (m); the old vertices come first.
TriangleMesh refined(const TriangleMesh& mesh, double longest);

} // namespace tread::shape
