#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#include "unit/shape/meshes.hpp"

// Meshes with defects that exporters produce.
namespace tread::test
{

/// Concatenates two meshes without sharing vertices.
inline shape::TriangleMesh together(shape::TriangleMesh one, const shape::TriangleMesh& other)
{
    const auto before = static_cast<std::int32_t>(one.vertices.size());
    one.vertices.insert(one.vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const auto& t : other.triangles) { one.triangles.push_back({t[0] + before, t[1] + before, t[2] + before}); }
    return one;
}

inline shape::TriangleMesh inside_out(shape::TriangleMesh mesh)
{
    for (auto& triangle : mesh.triangles) { std::swap(triangle[1], triangle[2]); }
    return mesh;
}

/// Gives every triangle its own vertices, as in an STL file before welding.
inline shape::TriangleMesh unwelded(const shape::TriangleMesh& mesh)
{
    shape::TriangleMesh soup;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    {
        const auto first = static_cast<std::int32_t>(soup.vertices.size());
        for (std::size_t c = 0; c < 3; ++c) { soup.vertices.push_back(shape::corner(mesh, t, c)); }
        soup.triangles.push_back({first, first + 1, first + 2});
    }
    return soup;
}

/// A solid of outer edge 2 with a cubic void of edge 1.
inline shape::TriangleMesh nested_shells() { return together(cube(2), inside_out(cube(1))); }

/// Two boxes that share the square x = 0 of edge 1.
inline shape::TriangleMesh touching_boxes()
{
    return together(box_mesh({-1, 0, 0}, {0, 1, 1}), box_mesh({0, 0, 0}, {2, 1, 1}));
}

/// Two unit cubes that overlap in an eighth of their volume.
inline shape::TriangleMesh overlapping_cubes()
{
    return together(box_mesh({0, 0, 0}, {1, 1, 1}), box_mesh({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}));
}

/// A cube of edge 2 whose first two faces are duplicated, with reversed orientation.
inline shape::TriangleMesh doubled_faces()
{
    shape::TriangleMesh mesh = cube(2);
    for (std::size_t t = 0; t < 4; ++t)
    {
        const auto triangle = mesh.triangles[t];
        mesh.triangles.push_back({triangle[0], triangle[2], triangle[1]});
    }
    return mesh;
}

} // namespace tread::test
