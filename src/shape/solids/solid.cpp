#include "shape/solids/solid.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "shape/mesh/components.hpp"
#include "shape/mesh/triangle_crossing.hpp"
#include "shape/repair/repair.hpp"
#include "shape/solids/boundary.hpp"
#include "shape/solids/part_volumes.hpp"
#include "shape/solids/sampled_mass.hpp"

namespace tread::shape
{
namespace
{

/// Conflicts between parts of a closed surface.
struct Meeting
{
    std::size_t                    parts        = 0; ///< of the mesh
    std::size_t                    inside_out   = 0; ///< parts that face inwards although no part contains them
    Eigen::Vector3d                turned_place = Eigen::Vector3d::Zero(); ///< on the first of them
    std::optional<Eigen::Vector3d> place; ///< where the surface crosses, touches or encloses itself
};

Eigen::Vector3d middle_of(const Corners& triangle) { return (triangle[0] + triangle[1] + triangle[2]) / 3; }

/// Offset from the surface to its two sides, and smallest depth of an overlap.
double step_for(const TriangleMesh& mesh) { return 1e-6 * bounds(mesh).extent().maxCoeff(); }

bool share_a_corner(const TriangleMesh& mesh, std::size_t one, std::size_t other)
{
    const auto& theirs = mesh.triangles[other];
    return std::any_of(mesh.triangles[one].begin(), mesh.triangles[one].end(),
                       [&](std::int32_t vertex)
                       { return std::find(theirs.begin(), theirs.end(), vertex) != theirs.end(); });
}

/// First triangle that is crossed by another one without a common corner.
std::optional<std::size_t> find_crossing(const TriangleMesh& mesh, const TriangleTree& tree, double step)
{
    std::size_t first = mesh.triangles.size();
#pragma omp parallel for schedule(dynamic, 256) reduction(min : first)
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    {
        if (t > first) { continue; }
        const Corners own = corners(mesh, t);
        for (const std::int32_t entry : triangles_touching(tree, bounds(own), mesh.triangles.size()))
        {
            const auto other = static_cast<std::size_t>(entry);
            if (other <= t || share_a_corner(mesh, t, other)) { continue; }
            if (crosses(own, corners(mesh, other), step)) { first = std::min(first, t); }
        }
    }
    return first < mesh.triangles.size() ? std::optional(first) : std::nullopt;
}

/// Counts the parts that face inwards outside any part that faces outwards, and finds the first solid part that other
/// solid parts contain.
void judge_nesting(const TriangleMesh& mesh, const Components& parts, Meeting& meeting)
{
    const auto                holders = find_holders(mesh, parts);
    const std::vector<double> volumes = signed_volumes(mesh, parts);
    std::vector<std::size_t>  first(parts.count, mesh.triangles.size());
    for (std::size_t t = mesh.triangles.size(); t-- > 0;) { first[parts.of[t]] = t; }
    for (std::size_t p = 0; p < parts.count; ++p)
    {
        int around = 0; // winding number outside the part, next to it
        for (const std::size_t holder : holders[p]) { around += volumes[holder] < 0 ? -1 : 1; }
        const Eigen::Vector3d place = middle_of(corners(mesh, first[p]));
        if (volumes[p] > 0 && around > 0 && !meeting.place) { meeting.place = place; }
        if (volumes[p] >= 0 || around > 0) { continue; }
        if (meeting.inside_out++ == 0) { meeting.turned_place = place; }
    }
}

/// Finds conflicts. In the middle of a triangle the winding number is 1/2 if the part bounds the solid; another part
/// that touches it there or contains it adds to that.
Meeting find_meeting(const TriangleMesh& mesh)
{
    constexpr std::size_t samples = 256;

    const Components  parts   = find_components(mesh);
    const WindingTree winding = build_winding_tree(mesh);
    const double      step    = step_for(mesh);
    Meeting           meeting;
    meeting.parts = parts.count;
    if (const auto crossed = find_crossing(mesh, winding.tree, step))
    {
        meeting.place = middle_of(corners(mesh, *crossed));
    }
    judge_nesting(mesh, parts, meeting);
    for (const auto& of_part : sample_triangles(mesh, parts, samples))
    {
        for (const std::size_t t : of_part)
        {
            if (meeting.place) { return meeting; }
            const double beyond = winding_number_on(winding, corners(mesh, t), step) - 0.5;
            if (std::abs(beyond) > 0.25) { meeting.place = middle_of(corners(mesh, t)); }
        }
    }
    return meeting;
}

std::string place_text(const Eigen::Vector3d& place)
{
    return fmt::format("({:.6g}, {:.6g}, {:.6g}) m", place.x(), place.y(), place.z());
}

/// Defines inside and mass by winding number, with the boundary of that region as surface.
void sign_by_winding(Solid& solid, const std::string& origin)
{
    const double finest = bounds(solid.surface).extent().maxCoeff() / 256;
    solid.sign          = SignRule::winding_number;
    solid.parts         = std::move(solid.surface);
    solid.surface       = find_boundary(solid.parts, build_winding_tree(solid.parts), finest);
    if (solid.surface.triangles.empty())
    {
        throw InputError(fmt::format("{}: the mesh encloses nothing: its winding number passes 1/2 nowhere", origin));
    }
    solid.unit = sampled_mass_properties(bounds(solid.surface), prepare_distance(solid));
    solid.remarks.push_back(fmt::format("inside is where the winding number is over 1/2; mass properties by sampling, "
                                        "to about 0.1 %; {} triangles bound it",
                                        solid.surface.triangles.size()));
    if (!(solid.unit.volume > 0)) { throw InputError(fmt::format("{}: the mesh encloses no volume", origin)); }
    require_volume_of_parts(solid.parts, solid.unit.volume, origin);
}

void take_closed(Solid& solid, Repair repair, const std::string& origin)
{
    const Meeting meeting = find_meeting(solid.surface);
    if (meeting.inside_out > 0 && repair == Repair::none)
    {
        require_watertight(solid.surface, origin); // has a better message if the whole mesh is inside out
        throw InputError(fmt::format("{}: {} of its {} parts are inside out, the first at {}; they must be wound "
                                     "counter-clockwise seen from outside (repair = true would turn them)",
                                     origin, meeting.inside_out, meeting.parts, place_text(meeting.turned_place)));
    }
    if (!meeting.place && meeting.inside_out == 0)
    {
        solid.unit = mass_properties(solid.surface);
        if (meeting.parts > 1)
        {
            solid.remarks.push_back(fmt::format("{} closed surfaces that do not meet", meeting.parts));
        }
        return;
    }
    solid.remarks.push_back(fmt::format("its surface crosses, touches or encloses itself ({} parts, first seen at {}): "
                                        "the solid is what any part holds",
                                        meeting.parts, place_text(meeting.place.value_or(meeting.turned_place))));
    sign_by_winding(solid, origin);
}

std::string one_line(std::string defects)
{
    std::replace(defects.begin(), defects.end(), '\n', ';');
    return defects.empty() ? defects : defects.substr(1);
}

} // namespace

Solid make_solid(const TriangleMesh& mesh, Repair repair, const std::string& origin)
{
    Solid solid{mesh, {}, SignRule::pseudonormal, {}, {}};
    if (repair == Repair::tried)
    {
        Repaired repaired = repair_mesh(mesh);
        solid.surface     = std::move(repaired.mesh);
        solid.remarks     = report_lines(repaired.report);
    }
    if (solid.surface.triangles.empty())
    {
        throw InputError(
            fmt::format("{}: the mesh has no triangles{}", origin, repair == Repair::tried ? " of any area" : ""));
    }
    const std::string defects = describe_defects(solid.surface);
    if (defects.empty())
    {
        take_closed(solid, repair, origin);
        return solid;
    }
    if (repair == Repair::none)
    {
        throw InputError(
            fmt::format("{}: the mesh is not watertight:{}\n  repair = true would try to mend it", origin, defects));
    }
    solid.remarks.push_back("still not closed:" + one_line(defects));
    sign_by_winding(solid, origin);
    return solid;
}

MeshDistance prepare_distance(const Solid& solid)
{
    return solid.sign == SignRule::pseudonormal ? prepare_distance(solid.surface)
                                                : prepare_distance(solid.surface, solid.parts);
}

} // namespace tread::shape
