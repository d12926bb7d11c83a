#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "shape/mesh.hpp"

// Surfaces of revolution by rings of vertices about the y axis. An angle turns from z to x, as a wheel does that rolls
// towards +x; radians. Where the way along the profile is called "from one ring to the next", the surface faces
// e_angle x that way: outwards for a way along +y, towards +y for a way inwards.
namespace tread::shape
{

using Triangles = std::vector<std::array<std::int32_t, 3>>;

/// A closed ring of vertices; angles do not decrease and cover less than a turn.
struct Ring
{
    std::vector<std::int32_t> vertices;
    std::vector<double>       angles;
};

/// Appends the vertex at this angle, radius and y, and returns its index.
std::int32_t add_vertex(TriangleMesh& mesh, double angle, double radius, double y);

/// Ring of `count` vertices, evenly spread from `start` on.
Ring even_ring(TriangleMesh& mesh, int count, double start, double radius, double y);

/// Which diagonal halves the quadrangle of a column: first and next vertex of the ring `from`, then those of `to`.
enum class Diagonal
{
    first_to_next,
    next_to_first
};

/// Leans with the column, so that no edge spans a wider angle than the wider of a column and its lean.
Diagonal diagonal_along(const Ring& from, const Ring& to, std::size_t column);

/// Band between two rings of equally many vertices, column by column; by default with `diagonal_along`.
Triangles band(const Ring& from, const Ring& to);
Triangles band(const Ring& from, const Ring& to, const std::function<Diagonal(std::size_t column)>& diagonal);

/// Band between two rings that need not have equally many vertices: the ring that lags in angle advances.
Triangles zipped_band(const Ring& from, const Ring& to);

/// Triangles from a ring to one vertex on the axis.
Triangles fan(const Ring& from, std::int32_t apex);

/// Facing the other way.
Triangles reversed(Triangles triangles);

void append(TriangleMesh& mesh, const Triangles& triangles);

} // namespace tread::shape
