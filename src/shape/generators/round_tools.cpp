#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "shape/generators/rings.hpp"
#include "shape/generators/shear_ring.hpp"
#include "shape/generators/tools.hpp"
#include "shape/generators/wheel_form.hpp"

// Tools of revolution: a profile turned about the z axis.
namespace tread::shape
{
namespace
{

constexpr int round_columns = 180; ///< chords of 2 degrees

/// Corner of a profile, m.
struct Corner
{
    double radius, height;
};

double way(const Corner& from, const Corner& to)
{
    return std::hypot(to.radius - from.radius, to.height - from.height);
}

int rows_over(double way, double radius)
{
    return std::min(steps_over(way, 4 * std::numbers::pi * radius / round_columns), most_rows);
}

Ring ring_at(TriangleMesh& mesh, int count, const Corner& at)
{
    return even_ring(mesh, count, 0, at.radius, at.height);
}

/// Closes a ring by a flat face that goes to the axis and faces upwards, with ever fewer vertices.
Triangles disc(TriangleMesh& mesh, const Ring& edge, const Corner& at)
{
    Triangles triangles;
    Ring      last  = edge;
    const int count = static_cast<int>(edge.vertices.size());
    const int steps = std::max(3, rows_over(at.radius, at.radius));
    for (int step = steps - 1; step > 0; --step)
    {
        const double    part  = static_cast<double>(step) / steps;
        const int       fewer = std::max(6, static_cast<int>(std::lround(count * part)));
        const Ring      next  = ring_at(mesh, fewer, {part * at.radius, at.height});
        const Triangles band  = zipped_band(last, next);
        triangles.insert(triangles.end(), band.begin(), band.end());
        last = next;
    }
    const Triangles middle = fan(last, add_vertex(mesh, 0, 0, at.height));
    triangles.insert(triangles.end(), middle.begin(), middle.end());
    return triangles;
}

/// Surface from a ring at `from` to a tip on the axis, with flat facets.
Triangles tip(TriangleMesh& mesh, const Ring& edge, const Corner& from, double height)
{
    Triangles triangles;
    Ring      last  = edge;
    const int steps = std::max(3, rows_over(way(from, {0, height}), from.radius));
    for (int step = steps - 1; step > 0; --step)
    {
        const double part = static_cast<double>(step) / steps;
        const Ring   next = ring_at(mesh, round_columns, {part * from.radius, height + part * (from.height - height)});
        const Triangles rows = band(last, next);
        triangles.insert(triangles.end(), rows.begin(), rows.end());
        last = next;
    }
    const Triangles end = fan(last, add_vertex(mesh, 0, 0, height));
    triangles.insert(triangles.end(), end.begin(), end.end());
    return triangles;
}

/// Appends the surface between two corners of the profile and returns the ring at the second; `end`: that ring, if it
/// exists already.
Ring turn(TriangleMesh& mesh, const Ring& first, const Corner& from, const Corner& to, const Ring* end = nullptr)
{
    Ring      last = first;
    const int rows = rows_over(way(from, to), std::max(from.radius, to.radius));
    for (int row = 1; row <= rows; ++row)
    {
        const double part = static_cast<double>(row) / rows;
        const Corner at   = row == rows ? to
                                        : Corner{from.radius + part * (to.radius - from.radius),
                                               from.height + part * (to.height - from.height)};
        const Ring   next = row == rows && end != nullptr ? *end : ring_at(mesh, round_columns, at);
        append(mesh, band(last, next));
        last = next;
    }
    return last;
}

TriangleMesh upright(TriangleMesh mesh)
{
    stand_upright(mesh);
    return mesh;
}

} // namespace

void stand_upright(TriangleMesh& mesh)
{
    for (Eigen::Vector3d& vertex : mesh.vertices) { vertex = Eigen::Vector3d(vertex.z(), vertex.x(), vertex.y()); }
}

TriangleMesh tool_mesh(const scene::CylinderGenerator& cylinder)
{
    const Corner low{cylinder.radius, -0.5 * cylinder.length}, high{cylinder.radius, 0.5 * cylinder.length};
    TriangleMesh mesh;
    const Ring   foot = ring_at(mesh, round_columns, low);
    append(mesh, reversed(disc(mesh, foot, low)));
    append(mesh, disc(mesh, turn(mesh, foot, low, high), high));
    return upright(std::move(mesh));
}

TriangleMesh tool_mesh(const scene::ConeGenerator& cone)
{
    const double height = cone.base_radius / std::tan(0.5 * cone.apex_angle_deg * std::numbers::pi / 180);
    Corner       top{cone.base_radius, height};
    TriangleMesh mesh;
    Ring         last = ring_at(mesh, round_columns, top);
    append(mesh, reversed(tip(mesh, last, top, 0)));
    if (cone.shaft_radius > 0)
    {
        const Corner foot{cone.shaft_radius, height}, end{cone.shaft_radius, height + cone.shaft_length};
        if (foot.radius < top.radius) { last = turn(mesh, last, top, foot); }
        last = turn(mesh, last, foot, end);
        top  = end;
    }
    append(mesh, disc(mesh, last, top));
    return upright(std::move(mesh));
}

TriangleMesh tool_mesh(const scene::TubeGenerator& tube)
{
    const double inner = tube.radius - tube.wall_thickness, low = -0.5 * tube.length, high = 0.5 * tube.length;
    TriangleMesh mesh;
    const Ring   first = ring_at(mesh, round_columns, {inner, low});
    Ring         last  = turn(mesh, first, {inner, low}, {tube.radius, low});
    last               = turn(mesh, last, {tube.radius, low}, {tube.radius, high});
    last               = turn(mesh, last, {tube.radius, high}, {inner, high});
    turn(mesh, last, {inner, high}, {inner, low}, &first);
    return upright(std::move(mesh));
}

TriangleMesh tool_mesh(const scene::RingGenerator& ring)
{
    if (ring.vanes > 0) { return vaned_ring(ring); }
    return tool_mesh(scene::TubeGenerator{ring.outer_radius, ring.outer_radius - ring.inner_radius, ring.height});
}

double tool_spacing(const scene::CylinderGenerator& cylinder)
{
    return std::min(std::max(2 * cylinder.radius, cylinder.length) / 40, cylinder.radius / 8);
}

double tool_spacing(const scene::ConeGenerator& cone)
{
    const double height =
        cone.base_radius / std::tan(0.5 * cone.apex_angle_deg * std::numbers::pi / 180) + cone.shaft_length;
    return std::min(std::max(2 * cone.base_radius, height) / 40, cone.base_radius / 8);
}

double tool_spacing(const scene::TubeGenerator& tube)
{
    return std::min(std::max(2 * tube.radius, tube.length) / 40, tube.radius / 8);
}

double tool_spacing(const scene::RingGenerator& ring)
{
    const double usual = std::min(2 * ring.outer_radius / 40, (ring.outer_radius - ring.inner_radius) / 8);
    return ring.vanes > 0 ? std::min(usual, 0.5 * ring.vane_height) : usual;
}

} // namespace tread::shape
