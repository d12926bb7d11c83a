#include <algorithm>
#include <array>
#include <cstdint>

#include "shape/generators/rings.hpp"
#include "shape/generators/tools.hpp"

// Tools with flat faces alone.
namespace tread::shape
{
namespace
{

using Rectangle = std::array<std::int32_t, 4>; ///< corners, counter-clockwise seen from above

/// Appends the corners of a rectangle of edges x, y (m), with its middle on the z axis.
Rectangle add_rectangle(TriangleMesh& mesh, double x, double y, double z)
{
    const auto first = static_cast<std::int32_t>(mesh.vertices.size());
    for (const auto& [way_x, way_y] : {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)})
    {
        mesh.vertices.emplace_back(0.5 * way_x * x, 0.5 * way_y * y, z);
    }
    return {first, first + 1, first + 2, first + 3};
}

/// Face of a rectangle, upwards.
Triangles face(const Rectangle& r) { return {{r[0], r[1], r[2]}, {r[0], r[2], r[3]}}; }

/// Four faces between two rectangles: outwards from a lower to an upper one, upwards from an outer to an inner one.
Triangles belt(const Rectangle& from, const Rectangle& to)
{
    Triangles triangles;
    for (std::size_t i = 0; i < 4; ++i)
    {
        const std::size_t next = (i + 1) % 4;
        triangles.push_back({from[i], from[next], to[next]});
        triangles.push_back({from[i], to[next], to[i]});
    }
    return triangles;
}

TriangleMesh rectangular(double x, double y, double z)
{
    TriangleMesh    mesh;
    const Rectangle low = add_rectangle(mesh, x, y, -0.5 * z), high = add_rectangle(mesh, x, y, 0.5 * z);
    append(mesh, reversed(face(low)));
    append(mesh, belt(low, high));
    append(mesh, face(high));
    return mesh;
}

} // namespace

TriangleMesh tool_mesh(const scene::BoxGenerator& box) { return rectangular(box.size[0], box.size[1], box.size[2]); }

TriangleMesh tool_mesh(const scene::PlateGenerator& plate)
{
    if (plate.radius) { return tool_mesh(scene::CylinderGenerator{*plate.radius, plate.thickness}); }
    return rectangular((*plate.size)[0], (*plate.size)[1], plate.thickness);
}

TriangleMesh tool_mesh(const scene::FrameGenerator& frame)
{
    const auto [x, y] = frame.inner_size;
    const double wide = 2 * frame.wall_thickness, low = -0.5 * frame.height, high = 0.5 * frame.height;
    const double inner_low = low + frame.floor_thickness;
    TriangleMesh mesh;

    const Rectangle outer_foot = add_rectangle(mesh, x + wide, y + wide, low);
    const Rectangle outer_top  = add_rectangle(mesh, x + wide, y + wide, high);
    const Rectangle inner_top  = add_rectangle(mesh, x, y, high);
    const Rectangle inner_foot = add_rectangle(mesh, x, y, inner_low);
    append(mesh, belt(outer_foot, outer_top));
    append(mesh, belt(outer_top, inner_top));
    append(mesh, belt(inner_top, inner_foot));
    if (frame.floor_thickness > 0)
    {
        append(mesh, face(inner_foot));
        append(mesh, reversed(face(outer_foot)));
    }
    else { append(mesh, belt(inner_foot, outer_foot)); }
    return mesh;
}

double tool_spacing(const scene::BoxGenerator& box) { return *std::max_element(box.size.begin(), box.size.end()) / 40; }

double tool_spacing(const scene::PlateGenerator& plate)
{
    const double extent = plate.radius ? 2 * *plate.radius : std::max((*plate.size)[0], (*plate.size)[1]);
    return std::max(extent, plate.thickness) / 40;
}

double tool_spacing(const scene::FrameGenerator& frame)
{
    const double inner = std::max(frame.inner_size[0], frame.inner_size[1]);
    return std::max(inner + 2 * frame.wall_thickness, frame.height) / 40;
}

} // namespace tread::shape
