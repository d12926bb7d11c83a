#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "shape/mesh/mesh.hpp"

namespace tread::shape
{

/// Counts of what repair_mesh changed.
struct RepairReport
{
    double       tolerance          = 0; ///< m, below which vertices are merged
    std::int64_t welded_vertices    = 0;
    std::int64_t dropped_degenerate = 0; ///< triangles
    std::int64_t dropped_duplicates = 0; ///< triangles
    std::int64_t dropped_walls      = 0; ///< triangles, two or more at one position, between parts that touch
    std::int64_t split_seams        = 0; ///< open edges split at vertices that lie on them
    std::int64_t turned_triangles   = 0; ///< reversed to match their neighbours
    std::int64_t turned_parts       = 0; ///< reversed as a whole
    std::int64_t cavities           = 0; ///< closed inner surfaces that bound a void
    std::int64_t closed_holes       = 0;
    std::int64_t hole_triangles     = 0; ///< added to close them
    std::int64_t open_holes         = 0; ///< left open: too large, or without a triangulation

    bool operator==(const RepairReport&) const = default;
};

struct Repaired
{
    TriangleMesh mesh;
    RepairReport report;
};

/// Repairs defects that mesh exporters commonly produce, in this order: vertices within 1e-6 of the largest extent (or
/// four roundings of single precision at the largest coordinate) are merged; triangles without area and copies of
/// triangles (same three vertices, either winding) are removed; open edges are split at open vertices that lie on them;
/// triangles are wound like their neighbours; holes of at most 4 edges, or within 10 % of the mesh's extent, are
/// closed.
///
/// An even number of triangles at one position is a wall between parts that touch, and is removed if its rim meets
/// surface on both sides; otherwise one of them is kept.
///
/// Finally, parts that no other part contains (find_holders) face outwards. A part within others keeps its orientation
/// relative to them (facing inwards = cavity) if no triangle had to be reversed and all outer parts agreed; otherwise
/// parity decides: within one part it is a cavity, within two it is solid.
///
/// The result need not be closed: find_defects reports what remains.
Repaired repair_mesh(const TriangleMesh& mesh);

/// One line per kind of change; empty if nothing changed.
std::vector<std::string> report_lines(const RepairReport& report);

} // namespace tread::shape
