#pragma once

#include <string>
#include <vector>

#include "shape/mass_properties.hpp"
#include "shape/mesh.hpp"
#include "shape/mesh_distance.hpp"

namespace tread::shape
{

/// What to do about a mesh that is not clean.
enum class Repair
{
    none, ///< refuse it
    tried ///< repair_mesh, and winding numbers for what that leaves
};

/// A mesh of which it is known what is inside.
struct Solid
{
    TriangleMesh             surface; ///< bounds the solid
    TriangleMesh             parts;   ///< by winding number: all triangles that tell inside from outside; else empty
    SignRule                 sign;
    MassProperties           unit;    ///< density 1, in the frame of the mesh
    std::vector<std::string> remarks; ///< what was done to the mesh and what that means, a line each
};

/// Takes a user's mesh. A closed one whose parts do not meet is taken as it is, with pseudonormals and exact mass
/// properties. A closed one whose parts overlap, touch, or lie in each other as solids is the union of its parts, told
/// by winding number. One with defects is refused without repair: InputError names `origin`, the defects, and the key
/// that would have helped. With repair, what is still not closed is told by winding number, too. What is told by
/// winding number is refused if it has not the volume of its parts (require_volume_of_parts).
Solid make_solid(const TriangleMesh& mesh, Repair repair, const std::string& origin);

MeshDistance prepare_distance(const Solid& solid);

} // namespace tread::shape
