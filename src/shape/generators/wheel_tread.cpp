#include "shape/generators/wheel_tread.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tread::shape
{
namespace
{

/// Angle of a grouser's centre line at y.
double middle_angle(const WheelGrid& grid, int pitch, double y) { return pitch * grid.pitch + sweep(grid.wheel, y); }

/// Distance (m) along the circumference from a grouser's centre line to its line `column`.
double across(const WheelGrid& grid, int column)
{
    return grid.wheel.grouser_width * (static_cast<double>(column) / grid.foot_columns - 0.5);
}

double foot_angle(const WheelGrid& grid, double y, int column)
{
    return std::asin(across(grid, column) / drum_radius(grid.wheel, y));
}

/// Section of one grouser at y: a slab from the drum to a flat tip, whose corners are at the outer radius.
class Section
{
public:
    Section(TriangleMesh& mesh, const WheelGrid& grid, int pitch, double y)
        : mesh_(mesh)
        , grid_(grid)
        , middle_(middle_angle(grid, pitch, y))
        , y_(y)
        , drum_(drum_radius(grid.wheel, y))
        , tip_(tip_radius(grid.wheel, y))
    {
    }

    /// Appends to `ring` the point at a column across and a level above the drum.
    void add(Ring& ring, int column, int level) const
    {
        const double aside  = across(grid_, column);
        const double half   = 0.5 * grid_.wheel.grouser_width;
        const double foot   = std::sqrt(drum_ * drum_ - aside * aside);
        const double height = std::sqrt(tip_ * tip_ - half * half);
        const double here   = foot + (height - foot) * level / grid_.levels;
        ring.angles.push_back(middle_ + std::atan2(aside, here));
        ring.vertices.push_back(add_vertex(mesh_, ring.angles.back(), std::hypot(aside, here), y_));
    }

private:
    TriangleMesh&    mesh_;
    const WheelGrid& grid_;
    double           middle_, y_, drum_, tip_;
};

void add_gap(Ring& ring, TriangleMesh& mesh, const WheelGrid& grid, int pitch, double y)
{
    const double foot  = grid.foot_columns > 0 ? foot_angle(grid, y, grid.foot_columns) : 0.0;
    const int    first = grid.foot_columns > 0 ? 1 : 0;
    for (int column = first; column < grid.gap_columns; ++column)
    {
        const double way = (grid.pitch - 2 * foot) * column / grid.gap_columns;
        ring.angles.push_back(middle_angle(grid, pitch, y) + foot + way);
        ring.vertices.push_back(add_vertex(mesh, ring.angles.back(), drum_radius(grid.wheel, y), y));
    }
}

/// Ring up each grouser, over its tip and down, and along the drum to the next.
Ring tread_ring(TriangleMesh& mesh, const WheelGrid& grid, double y)
{
    Ring ring;
    for (int pitch = 0; pitch < grid.pitches; ++pitch)
    {
        if (grid.foot_columns > 0)
        {
            const Section section(mesh, grid, pitch, y);
            for (int level = 0; level < grid.levels; ++level) { section.add(ring, 0, level); }
            for (int column = 0; column <= grid.foot_columns; ++column) { section.add(ring, column, grid.levels); }
            for (int level = grid.levels; level > 0; --level) { section.add(ring, grid.foot_columns, level - 1); }
        }
        add_gap(ring, mesh, grid, pitch, y);
    }
    return ring;
}

/// Band of the tread. The sides of a swept grouser are twisted: with like diagonals from foot to tip, one side gains
/// the volume that the other loses, and the grouser keeps its volume. Symmetric towards both ends of the axle.
Triangles tread_band(const WheelGrid& grid, const Ring& from, const Ring& to, double middle_y)
{
    const int each = static_cast<int>(from.vertices.size()) / grid.pitches;
    return band(from, to,
                [&](std::size_t column)
                {
                    const int  at     = static_cast<int>(column) % each;
                    const bool rising = at < grid.levels;
                    const bool wall =
                        rising || (at >= grid.levels + grid.foot_columns && at < 2 * grid.levels + grid.foot_columns);
                    if (grid.foot_columns == 0 || !wall) { return diagonal_along(from, to, column); }
                    return rising == (middle_y > 0) ? Diagonal::first_to_next : Diagonal::next_to_first;
                });
}

/// Appends a grouser's end, whose outline starts at `first` of the row, level by level; appends its feet to `feet`.
void add_grouser_end(TriangleMesh& mesh, const WheelGrid& grid, Side side, int pitch, double y, const Ring& row,
                     std::size_t first, Ring& feet)
{
    const Section section(mesh, grid, pitch, y);
    const int     levels = grid.levels, columns = grid.foot_columns;
    const auto    take = [&](Ring& ring, int at)
    {
        ring.vertices.push_back(row.vertices[first + static_cast<std::size_t>(at)]);
        ring.angles.push_back(row.angles[first + static_cast<std::size_t>(at)]);
    };
    Ring below;
    for (int level = 0; level <= levels; ++level)
    {
        Ring line;
        for (int column = 0; column <= columns; ++column)
        {
            if (level == levels || column == 0) { take(line, level + column); }
            else if (column == columns) { take(line, 2 * levels + columns - level); }
            else { section.add(line, column, level); }
        }
        if (level == 0)
        {
            feet.vertices.insert(feet.vertices.end(), line.vertices.begin(), line.vertices.end());
            feet.angles.insert(feet.angles.end(), line.angles.begin(), line.angles.end());
        }
        for (std::size_t i = 0; level > 0 && i + 1 < line.vertices.size(); ++i)
        {
            append(mesh, side,
                   {{below.vertices[i], line.vertices[i], line.vertices[i + 1]},
                    {below.vertices[i], line.vertices[i + 1], below.vertices[i + 1]}});
        }
        below = line;
    }
}

/// Closes the grousers' ends and returns the drum's edge under them.
Ring edge_ring(TriangleMesh& mesh, const WheelGrid& grid, Side side, double y, const Ring& row)
{
    if (grid.foot_columns == 0) { return row; }
    const std::size_t each = row.vertices.size() / static_cast<std::size_t>(grid.pitches);
    const std::size_t over = static_cast<std::size_t>(2 * grid.levels + grid.foot_columns + 1);
    Ring              edge;
    for (int pitch = 0; pitch < grid.pitches; ++pitch)
    {
        const std::size_t first = each * static_cast<std::size_t>(pitch);
        add_grouser_end(mesh, grid, side, pitch, y, row, first, edge);
        for (std::size_t i = over; i < each; ++i)
        {
            edge.vertices.push_back(row.vertices[first + i]);
            edge.angles.push_back(row.angles[first + i]);
        }
    }
    return edge;
}

} // namespace

void append(TriangleMesh& mesh, Side side, const Triangles& triangles)
{
    append(mesh, side == Side::right ? triangles : reversed(triangles));
}

TreadEdges add_tread(TriangleMesh& mesh, const WheelGrid& grid)
{
    std::vector<Ring> rings;
    for (const double y : grid.rows) { rings.push_back(tread_ring(mesh, grid, y)); }
    for (std::size_t i = 0; i + 1 < rings.size(); ++i)
    {
        append(mesh, tread_band(grid, rings[i], rings[i + 1], 0.5 * (grid.rows[i] + grid.rows[i + 1])));
    }
    return {edge_ring(mesh, grid, Side::left, grid.rows.front(), rings.front()),
            edge_ring(mesh, grid, Side::right, grid.rows.back(), rings.back())};
}

Ring drum_ring(TriangleMesh& mesh, const WheelGrid& grid, double y, double radius)
{
    Ring ring;
    for (int pitch = 0; pitch < grid.pitches; ++pitch)
    {
        const double middle = middle_angle(grid, pitch, y);
        const double foot   = grid.foot_columns > 0 ? foot_angle(grid, y, grid.foot_columns) : 0.0;
        for (int column = 0; column < grid.foot_columns; ++column)
        {
            ring.angles.push_back(middle + foot_angle(grid, y, column));
        }
        for (int column = 0; column < grid.gap_columns; ++column)
        {
            ring.angles.push_back(middle + foot + (grid.pitch - 2 * foot) * column / grid.gap_columns);
        }
    }
    for (const double angle : ring.angles) { ring.vertices.push_back(add_vertex(mesh, angle, radius, y)); }
    return ring;
}

} // namespace tread::shape
