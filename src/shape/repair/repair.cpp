#include "shape/repair/repair.hpp"

#include <fmt/format.h>

#include "shape/mesh/mesh_reader.hpp"
#include "shape/mesh/triangle.hpp"
#include "shape/repair/repair_steps.hpp"

namespace tread::shape
{

void drop_degenerate(TriangleMesh& mesh, RepairReport& report)
{
    std::vector<std::array<std::int32_t, 3>> kept;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    {
        if (!is_degenerate(mesh, t)) { kept.push_back(mesh.triangles[t]); }
    }
    report.dropped_degenerate += static_cast<std::int64_t>(mesh.triangles.size() - kept.size());
    mesh.triangles = std::move(kept);
}

Repaired repair_mesh(const TriangleMesh& mesh)
{
    Repaired result{mesh, {}};
    weld_near(result.mesh, result.report);
    drop_degenerate(result.mesh, result.report);
    drop_duplicates(result.mesh, result.report);
    split_seams(result.mesh, result.report);
    const Winding winding = wind_alike(result.mesh, result.report);
    close_holes(result.mesh, result.report);
    orient_parts(result.mesh, winding, result.report);
    result.mesh = weld(result.mesh); // removes vertices that are no longer used
    return result;
}

std::vector<std::string> report_lines(const RepairReport& report)
{
    std::vector<std::string> lines;
    const auto               say = [&](std::int64_t count, const char* text)
    {
        if (count > 0) { lines.push_back(fmt::format("repair: {} {}", count, text)); }
    };
    if (report.welded_vertices > 0)
    {
        lines.push_back(fmt::format("repair: {} vertices welded to others within {:.3g} m", report.welded_vertices,
                                    report.tolerance));
    }
    say(report.dropped_degenerate, "triangles without area dropped");
    say(report.dropped_duplicates, "duplicate triangles dropped");
    say(report.dropped_walls, "triangles of walls between touching parts dropped");
    say(report.split_seams, "open edges divided at vertices that lie on them");
    say(report.turned_triangles, "triangles wound like their neighbours");
    say(report.turned_parts, "whole parts turned");
    say(report.cavities, "inner surfaces taken as cavities");
    if (report.closed_holes > 0)
    {
        lines.push_back(
            fmt::format("repair: {} holes closed by {} triangles", report.closed_holes, report.hole_triangles));
    }
    say(report.open_holes,
        "holes left open (more than 4 edges and over 10 % of the extent, or not to be triangulated)");
    return lines;
}

} // namespace tread::shape
