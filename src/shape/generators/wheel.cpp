#include <algorithm>
#include <cmath>
#include <numbers>

#include "shape/generators/generators.hpp"
#include "shape/generators/wheel_tread.hpp"

// The inside of the drum uses the columns of the tread, so that the wall has uniform thickness. Flanges, web and hub
// are surfaces of revolution.
namespace tread::shape
{
namespace
{

/// The inside of one half of a wheel, from the drum's edge inwards.
class HalfInside
{
public:
    HalfInside(TriangleMesh& mesh, const WheelGrid& grid, Side side, const Ring& edge)
        : mesh_(mesh)
        , grid_(grid)
        , wheel_(grid.wheel)
        , side_(side)
        , last_(edge)
    {
    }

    /// Appends the surface from the drum's edge to the web, or to the other half of the open drum.
    void drum()
    {
        const double edge = 0.5 * wheel_.width, stop = 0.5 * wheel_.web_thickness, flange = edge - wheel_.rim_thickness;
        cap(edge);
        const bool has_flange = wheel_.rim_height > 0;
        if (has_flange) { turn_flange(edge, flange); }
        for (auto y = grid_.rows.rbegin() + 1; *y > 0 && *y >= stop; ++y)
        {
            if (!has_flange || *y < flange) { join(band(last_, at_drum(*y))); }
            else if (*y == flange) { join(zipped_band(last_, at_drum(*y))); }
        }
    }

    void web_and_hub()
    {
        const double foot = 0.5 * wheel_.web_thickness, top = 0.5 * wheel_.hub_width;
        turn_face(foot, inner_radius(wheel_, foot), wheel_.hub_radius);
        turn_side(foot, top, wheel_.hub_radius);

        const int count = static_cast<int>(last_.vertices.size());
        const int steps = std::max(3, steps_over(wheel_.hub_radius, 2 * grid_.chord));
        for (int step = steps - 1; step > 0; --step)
        {
            const double part   = static_cast<double>(step) / steps;
            const int    fewer  = std::max(6, static_cast<int>(std::lround(count * part)));
            const double radius = part * wheel_.hub_radius;
            join(zipped_band(last_, turned(fewer, radius, top)));
        }
        append(mesh_, side_, fan(last_, add_vertex(mesh_, 0, 0, at_side(top))));
    }

    /// Appends a band to a ring that both halves share.
    void meet(const Ring& middle) { append(mesh_, side_, band(last_, middle)); }

private:
    double at_side(double y) const { return side_ == Side::right ? y : -y; }

    Ring& at_drum(double y) { return next_ = drum_ring(mesh_, grid_, at_side(y), inner_radius(wheel_, y)); }

    Ring& turned(int count, double radius, double y)
    {
        return next_ = even_ring(mesh_, count, last_.angles.front(), radius, at_side(y));
    }

    /// Appends the band to the next ring, which then becomes the last one.
    void join(const Triangles& triangles)
    {
        append(mesh_, side_, triangles);
        last_ = next_;
    }

    /// Appends the cap across the wall, with the columns of the tread.
    void cap(double edge)
    {
        const int steps = steps_over(wheel_.wall_thickness, 2 * grid_.chord);
        for (int step = 1; step <= steps; ++step)
        {
            const double radius = drum_radius(wheel_, edge) - wheel_.wall_thickness * step / steps;
            next_               = drum_ring(mesh_, grid_, at_side(edge), radius);
            join(band(last_, next_));
        }
    }

    /// Appends the flange: inwards along the cap, back along the bore, and outwards to the ring before the drum's.
    void turn_flange(double edge, double flange)
    {
        turn_face(edge, inner_radius(wheel_, edge), rim_radius(wheel_));
        turn_side(edge, flange, rim_radius(wheel_));
        const double way   = inner_radius(wheel_, flange) - rim_radius(wheel_);
        const int    steps = steps_over(way, grid_.chord);
        for (int step = 1; step < steps; ++step)
        {
            const double radius = rim_radius(wheel_) + way * step / steps;
            join(zipped_band(last_, turned(corners(radius), radius, flange)));
        }
    }

    /// Appends a plane at y, between two radii, inwards.
    void turn_face(double y, double from, double to)
    {
        const int steps = steps_over(from - to, grid_.chord);
        for (int step = 1; step <= steps; ++step)
        {
            const double radius = step == steps ? to : from - (from - to) * step / steps;
            join(zipped_band(last_, turned(corners(radius), radius, y)));
        }
    }

    /// Appends a cylinder between two positions y.
    void turn_side(double from, double to, double radius)
    {
        const int count = static_cast<int>(last_.vertices.size());
        const int steps = steps_over(std::abs(to - from), 4 * std::numbers::pi * radius / count);
        for (int step = 1; step <= steps; ++step)
        {
            join(band(last_, turned(count, radius, step == steps ? to : from + (to - from) * step / steps)));
        }
    }

    /// Number of corners of a turned ring: 60 lose 0.2 % of the disc's area.
    int corners(double radius) const { return std::max(60, steps_over(2 * std::numbers::pi * radius, grid_.chord)); }

    TriangleMesh&                mesh_;
    const WheelGrid&             grid_;
    const scene::WheelGenerator& wheel_;
    Side                         side_;
    Ring                         last_, next_;
};

} // namespace

TriangleMesh wheel_mesh(const scene::WheelGenerator& generator, const std::string& origin)
{
    check_wheel(generator, origin);
    const WheelGrid  grid = wheel_grid(generator);
    TriangleMesh     mesh;
    const TreadEdges edges = add_tread(mesh, grid);
    HalfInside       left(mesh, grid, Side::left, edges.left), right(mesh, grid, Side::right, edges.right);
    left.drum();
    right.drum();
    if (generator.hub_radius > 0)
    {
        left.web_and_hub();
        right.web_and_hub();
        return mesh;
    }
    const Ring middle = drum_ring(mesh, grid, 0, inner_radius(generator, 0));
    left.meet(middle);
    right.meet(middle);
    return mesh;
}

} // namespace tread::shape
