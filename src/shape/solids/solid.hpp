#pragma once

#include <string>
#include <vector>

#include "shape/distance/mesh_distance.hpp"
#include "shape/mesh/mesh.hpp"
#include "shape/solids/mass_properties.hpp"

namespace tread::shape
{

/// Treatment of a mesh with defects.
enum class Repair
{
    none, ///< refuse it
    tried ///< repair_mesh, and winding numbers for remaining defects
};

/// A mesh with a well-defined inside.
struct Solid
{
    TriangleMesh             surface; ///< bounds the solid
    TriangleMesh             parts;   ///< with winding numbers: all triangles that define the inside; else empty
    SignRule                 sign;
    MassProperties           unit;        ///< density 1, in the frame of the mesh
    std::vector<std::string> remarks;     ///< changes to the mesh and their meaning, one line each
    std::vector<Solid>       united = {}; ///< with SignRule::any_part: the solids that it is the union of
};

/// Makes a solid of a user's mesh. A closed one whose parts do not meet is used unchanged, with pseudonormals and exact
/// mass properties. A closed one whose parts overlap, touch, or contain each other as solids is the union of its parts,
/// by winding number. One with defects is refused without repair: InputError names `origin`, the defects, and the key
/// that would have helped. With repair, the inside of what is still open is also defined by winding number. A solid by
/// winding number is refused if its volume is not that of its parts (require_volume_of_parts).
Solid make_solid(const TriangleMesh& mesh, Repair repair, const std::string& origin);

MeshDistance prepare_distance(const Solid& solid);

} // namespace tread::shape
