#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "shape/mesh.hpp"

namespace tread::shape
{

/// What repair_mesh did; counts.
struct RepairReport
{
    double       tolerance          = 0; ///< m, up to which vertices are one
    std::int64_t welded_vertices    = 0;
    std::int64_t dropped_degenerate = 0; ///< triangles
    std::int64_t dropped_duplicates = 0; ///< triangles
    std::int64_t dropped_walls      = 0; ///< triangles, two or more at one place, between parts that touch
    std::int64_t split_seams        = 0; ///< open edges divided at vertices that lie on them
    std::int64_t turned_triangles   = 0; ///< against their neighbours
    std::int64_t turned_parts       = 0; ///< as a whole
    std::int64_t cavities           = 0; ///< closed inner surfaces that bound a void
    std::int64_t closed_holes       = 0;
    std::int64_t hole_triangles     = 0; ///< that close them
    std::int64_t open_holes         = 0; ///< too large, or without a triangulation

    bool operator==(const RepairReport&) const = default;
};

struct Repaired
{
    TriangleMesh mesh;
    RepairReport report;
};

/// Mends what exporters of meshes commonly break, in this order: vertices within 1e-6 of the largest extent (or four
/// roundings of single precision at the largest coordinate) become one; triangles without area and copies of triangles
/// (same three vertices, either winding) go; open edges are divided at open vertices that lie on them; triangles are
/// wound like their neighbours; holes of at most 4 edges, or within 10 % of the mesh's extent, are closed.
///
/// An even number of triangles at one place is a wall between parts that touch, and goes altogether, where its rim
/// meets surface on both sides; elsewhere one of them stays.
///
/// In the end parts that lie in no other part (find_holders) face outwards. A part within others keeps the sense that
/// it has in the file relative to them (facing inwards = cavity), if no triangle had to be wound anew and all outer
/// parts agreed; else parity decides: within one part it is a cavity, within two it is solid.
///
/// The result need not be closed: find_defects says what is left.
Repaired repair_mesh(const TriangleMesh& mesh);

/// One line for each thing that was done; empty if nothing was.
std::vector<std::string> report_lines(const RepairReport& report);

} // namespace tread::shape
