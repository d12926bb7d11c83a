#pragma once

#include "scene/shape.hpp"
#include "shape/mesh/mesh.hpp"

// Meshes of tools and vessels of soil mechanics: plates, cones, shear rings, shear boxes. Each is closed and in the
// frame of its generator (docs/shapes.md). Flat faces are exact; round ones have chords of at most 2 degrees, which
// remove 0.02 % of a disc. Parameters have passed the checks of a scene.
namespace tread::shape
{

TriangleMesh tool_mesh(const scene::BoxGenerator& box);
TriangleMesh tool_mesh(const scene::PlateGenerator& plate);
TriangleMesh tool_mesh(const scene::CylinderGenerator& cylinder);
TriangleMesh tool_mesh(const scene::ConeGenerator& cone);
TriangleMesh tool_mesh(const scene::RingGenerator& ring);
TriangleMesh tool_mesh(const scene::TubeGenerator& tube);
TriangleMesh tool_mesh(const scene::FrameGenerator& frame);

/// Default spacing (m) of a tool's surface nodes: a 40th of its largest extent, or less where it is slender, so that
/// 50 nodes go around a shaft and a vane carries two rows.
double tool_spacing(const scene::BoxGenerator& box);
double tool_spacing(const scene::PlateGenerator& plate);
double tool_spacing(const scene::CylinderGenerator& cylinder);
double tool_spacing(const scene::ConeGenerator& cone);
double tool_spacing(const scene::RingGenerator& ring);
double tool_spacing(const scene::TubeGenerator& tube);
double tool_spacing(const scene::FrameGenerator& frame);

} // namespace tread::shape
