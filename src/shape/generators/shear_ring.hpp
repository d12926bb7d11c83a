#pragma once

#include "scene/shape.hpp"
#include "shape/mesh/mesh.hpp"

namespace tread::shape
{

/// Mesh of a ring with vanes: each is a slab of even thickness whose ends are flush with the inner and the outer
/// cylinder. The middle of the annulus is the origin, the axis is z, the vanes point down.
TriangleMesh vaned_ring(const scene::RingGenerator& ring);

/// Turns a mesh about the y axis, as rings.hpp makes it, into one about the z axis.
void stand_upright(TriangleMesh& mesh);

} // namespace tread::shape
