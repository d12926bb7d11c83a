#include "shape/generators/rings.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace tread::shape
{
namespace
{

// Angles closer than this differ by rounding only, which must not decide between them.
constexpr double tie = 1e-9;

/// Ring rotated to start at vertex `first`; its angles continue beyond a turn.
Ring starting_at(const Ring& ring, std::size_t first)
{
    Ring turned;
    for (std::size_t i = 0; i < ring.vertices.size(); ++i)
    {
        const std::size_t at = (first + i) % ring.vertices.size();
        turned.vertices.push_back(ring.vertices[at]);
        turned.angles.push_back(ring.angles[at] + (at < first ? 2 * std::numbers::pi : 0.0));
    }
    return turned;
}

/// Ring rotated to start at the vertex whose angle, modulo a turn, is nearest to `start`.
Ring aligned(const Ring& ring, double start)
{
    const auto  offset  = [&](double angle) { return std::remainder(angle - start, 2 * std::numbers::pi); };
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < ring.angles.size(); ++i)
    {
        if (std::abs(offset(ring.angles[i])) < std::abs(offset(ring.angles[nearest])) - tie) { nearest = i; }
    }
    Ring         turned = starting_at(ring, nearest);
    const double shift  = start + offset(turned.angles.front()) - turned.angles.front();
    for (double& angle : turned.angles) { angle += shift; }
    return turned;
}

/// Ring with its first vertex repeated at the end, a turn later.
Ring closed(Ring ring)
{
    ring.vertices.push_back(ring.vertices.front());
    ring.angles.push_back(ring.angles.front() + 2 * std::numbers::pi);
    return ring;
}

} // namespace

std::int32_t add_vertex(TriangleMesh& mesh, double angle, double radius, double y)
{
    mesh.vertices.emplace_back(radius * std::sin(angle), y, radius * std::cos(angle));
    return static_cast<std::int32_t>(mesh.vertices.size() - 1);
}

Ring even_ring(TriangleMesh& mesh, int count, double start, double radius, double y)
{
    Ring ring;
    for (int i = 0; i < count; ++i)
    {
        ring.angles.push_back(start + 2 * std::numbers::pi * i / count);
        ring.vertices.push_back(add_vertex(mesh, ring.angles.back(), radius, y));
    }
    return ring;
}

Diagonal diagonal_along(const Ring& from, const Ring& to, std::size_t column)
{
    const std::size_t next = (column + 1) % from.angles.size();
    const double      lean = to.angles[column] + to.angles[next] - from.angles[column] - from.angles[next];
    return lean > tie ? Diagonal::next_to_first : Diagonal::first_to_next;
}

Triangles band(const Ring& from, const Ring& to)
{
    return band(from, to, [&](std::size_t column) { return diagonal_along(from, to, column); });
}

Triangles band(const Ring& from, const Ring& to, const std::function<Diagonal(std::size_t column)>& diagonal)
{
    const auto &a = from.vertices, &b = to.vertices;
    Triangles   triangles;
    for (std::size_t i = 0; i < a.size(); ++i)
    {
        const std::size_t next = (i + 1) % a.size();
        if (diagonal(i) == Diagonal::next_to_first)
        {
            triangles.push_back({a[i], a[next], b[i]});
            triangles.push_back({a[next], b[next], b[i]});
        }
        else
        {
            triangles.push_back({a[i], a[next], b[next]});
            triangles.push_back({a[i], b[next], b[i]});
        }
    }
    return triangles;
}

Triangles zipped_band(const Ring& from, const Ring& to)
{
    const Ring  a = closed(from), b = closed(aligned(to, from.angles.front()));
    Triangles   triangles;
    std::size_t i = 0, j = 0;
    while (i + 1 < a.vertices.size() || j + 1 < b.vertices.size())
    {
        const bool a_ended = i + 1 == a.vertices.size(), b_ended = j + 1 == b.vertices.size();
        if (b_ended || (!a_ended && a.angles[i] + a.angles[i + 1] < b.angles[j] + b.angles[j + 1] + tie))
        {
            triangles.push_back({a.vertices[i], a.vertices[i + 1], b.vertices[j]});
            ++i;
        }
        else
        {
            triangles.push_back({a.vertices[i], b.vertices[j + 1], b.vertices[j]});
            ++j;
        }
    }
    return triangles;
}

Triangles fan(const Ring& from, std::int32_t apex)
{
    const Ring a = closed(from);
    Triangles  triangles;
    for (std::size_t i = 0; i + 1 < a.vertices.size(); ++i)
    {
        triangles.push_back({a.vertices[i], a.vertices[i + 1], apex});
    }
    return triangles;
}

Triangles reversed(Triangles triangles)
{
    for (auto& triangle : triangles) { std::swap(triangle[1], triangle[2]); }
    return triangles;
}

void append(TriangleMesh& mesh, const Triangles& triangles)
{
    mesh.triangles.insert(mesh.triangles.end(), triangles.begin(), triangles.end());
}

} // namespace tread::shape
