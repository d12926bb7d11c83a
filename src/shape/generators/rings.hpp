#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "shape/mesh/mesh.hpp"

// Surfaces of revolution from rings of vertices about the y axis. Angles (radians) increase from z towards x, as a
// wheel turns that rolls towards +x. A surface from one ring to the next faces e_angle x profile direction: outwards if
// the profile goes along +y, towards +y if it goes inwards.
namespace tread::shape
{

using Triangles = std::vector<std::array<std::int32_t, 3>>;

/// Rings of a tool's surface along one line, at most.
inline constexpr int most_rows = 64;

/// A closed ring of vertices; angles are non-decreasing and cover less than a turn.
struct Ring
{
    std::vector<std::int32_t> vertices;
    std::vector<double>       angles;
};

/// Appends the vertex at this angle, radius and y, and returns its index.
std::int32_t add_vertex(TriangleMesh& mesh, double angle, double radius, double y);

/// Ring of `count` vertices, evenly spaced from `start`.
Ring even_ring(TriangleMesh& mesh, int count, double start, double radius, double y);

/// Diagonal that splits the quadrangle of a column: first and next vertex of the ring `from`, then those of `to`.
enum class Diagonal
{
    first_to_next,
    next_to_first
};

/// Diagonal that leans with the column, so that no edge spans a wider angle than the wider of the column and its lean.
Diagonal diagonal_along(const Ring& from, const Ring& to, std::size_t column);

/// Band between two rings of equally many vertices, column by column; by default with `diagonal_along`.
Triangles band(const Ring& from, const Ring& to);
Triangles band(const Ring& from, const Ring& to, const std::function<Diagonal(std::size_t column)>& diagonal);

/// Band between two rings of possibly different numbers of vertices: the ring that lags in angle advances.
Triangles zipped_band(const Ring& from, const Ring& to);

/// Triangle fan from a ring to one vertex on the axis.
Triangles fan(const Ring& from, std::int32_t apex);

/// Reverses the orientation of triangles.
Triangles reversed(Triangles triangles);

void append(TriangleMesh& mesh, const Triangles& triangles);

} // namespace tread::shape
