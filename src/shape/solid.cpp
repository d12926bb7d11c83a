#include "shape/solid.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "shape/boundary.hpp"
#include "shape/components.hpp"
#include "shape/repair.hpp"
#include "shape/sampled_mass.hpp"
#include "shape/triangle.hpp"

namespace tread::shape
{
namespace
{

/// What samples of a closed surface see: in the middle of a triangle the winding number is 1/2, the mean of 0 and 1.
struct Meeting
{
    std::size_t     parts      = 0;           ///< of the mesh
    std::size_t     inside     = 0;           ///< parts seen within others, or touching them
    std::size_t     inside_out = 0;           ///< parts that face inwards where there is nothing to be hollow
    Eigen::Vector3d inner_place, outer_place; ///< of the first of each
};

Meeting find_meeting(const TriangleMesh& mesh)
{
    constexpr std::size_t all = 4096, least = 8;

    const Components  parts   = find_components(mesh);
    const auto        samples = sample_triangles(parts, std::max(least, all / parts.count));
    const WindingTree winding = build_winding_tree(mesh);
    Meeting           meeting{parts.count, 0, 0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    for (const auto& of_part : samples)
    {
        bool inside = false, inside_out = false;
        for (const std::size_t t : of_part)
        {
            const Eigen::Vector3d middle = (corner(mesh, t, 0) + corner(mesh, t, 1) + corner(mesh, t, 2)) / 3;
            const double          beyond = winding_number(winding, middle) - 0.5;
            if (beyond > 0.25 && !inside && meeting.inside == 0) { meeting.inner_place = middle; }
            if (beyond < -0.25 && !inside_out && meeting.inside_out == 0) { meeting.outer_place = middle; }
            inside     = inside || beyond > 0.25;
            inside_out = inside_out || beyond < -0.25;
        }
        meeting.inside += inside ? 1 : 0;
        meeting.inside_out += inside_out ? 1 : 0;
    }
    return meeting;
}

std::string place_text(const Eigen::Vector3d& place)
{
    return fmt::format("({:.6g}, {:.6g}, {:.6g}) m", place.x(), place.y(), place.z());
}

/// Inside and mass by winding number, over the boundary of what that holds.
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
}

void take_closed(Solid& solid, Repair repair, const std::string& origin)
{
    const Meeting meeting = find_meeting(solid.surface);
    if (meeting.inside_out > 0 && repair == Repair::none)
    {
        require_watertight(solid.surface, origin); // says it better if all of it is inside out
        throw InputError(fmt::format("{}: {} of its {} parts are inside out, the first at {}; they must be wound "
                                     "counter-clockwise seen from outside (repair = true would turn them)",
                                     origin, meeting.inside_out, meeting.parts, place_text(meeting.outer_place)));
    }
    if (meeting.inside == 0 && meeting.inside_out == 0)
    {
        solid.unit = mass_properties(solid.surface);
        if (meeting.parts > 1)
        {
            solid.remarks.push_back(fmt::format("{} closed surfaces that do not meet", meeting.parts));
        }
        return;
    }
    solid.remarks.push_back(fmt::format("its surface meets or encloses itself ({} parts, seen first at {}): the solid "
                                        "is what any of them holds",
                                        meeting.parts,
                                        place_text(meeting.inside > 0 ? meeting.inner_place : meeting.outer_place)));
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
