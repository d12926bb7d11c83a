#pragma once

#include "shape/repair/repair.hpp"

// Steps of repair_mesh. Each changes the mesh and updates the report.
namespace tread::shape
{

void weld_near(TriangleMesh& mesh, RepairReport& report);
void drop_degenerate(TriangleMesh& mesh, RepairReport& report);
void drop_duplicates(TriangleMesh& mesh, RepairReport& report);
void split_seams(TriangleMesh& mesh, RepairReport& report);
void close_holes(TriangleMesh& mesh, RepairReport& report);

/// Whether the parts were wound consistently before wind_alike.
enum class Winding
{
    consistent,
    mixed
};

/// Winds triangles like their neighbours.
Winding wind_alike(TriangleMesh& mesh, RepairReport& report);

/// Reverses whole parts to face outwards, or inwards if they are cavities.
void orient_parts(TriangleMesh& mesh, Winding winding, RepairReport& report);

} // namespace tread::shape
