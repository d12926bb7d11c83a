#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "shape/generators.hpp"
#include "shape/rings.hpp"
#include "shape/wheel_form.hpp"

// The tread is a grid of columns, which follow the grousers, and rows across the axle. Caps, flanges and the drum's
// inside take over its columns, so that the wall is evenly thick; web and hub are turned discs.
namespace tread::shape
{
namespace
{

constexpr double pi = 3.14159265358979323846;

int steps_over(double way, double longest) { return std::max(1, static_cast<int>(std::ceil(way / longest - 1e-9))); }

/// Which end of the axle a surface lies towards.
enum class Side
{
    left,
    right
};

class WheelBuilder
{
public:
    explicit WheelBuilder(const scene::WheelGenerator& wheel)
        : wheel_(wheel)
        , rows_(wheel_rows(wheel))
        , chord_(longest_wheel_chord * drum_radius(wheel, 0))
        , pitch_(2 * pi / std::max(wheel.grousers, 1))
        , columns_(steps_over(pitch_ - 2 * half_angle(wheel, drum_radius(wheel, 0)), longest_wheel_chord))
    {
        tread();
        const Ring right = inside(Side::right), left = inside(Side::left);
        if (wheel_.hub_radius > 0)
        {
            web_and_hub(Side::right, right);
            web_and_hub(Side::left, left);
            return;
        }
        const Ring middle = drum_ring(0, inner_radius(wheel_, 0));
        face(Side::right, band(right, middle));
        face(Side::left, band(left, middle));
    }

    TriangleMesh mesh;

private:
    /// Columns of the drum at y: both feet of each grouser, then the chords up to the next.
    std::vector<double> drum_angles(double y) const
    {
        const double        foot = half_angle(wheel_, drum_radius(wheel_, y));
        std::vector<double> angles;
        for (int pitch = 0; pitch < std::max(wheel_.grousers, 1); ++pitch)
        {
            const double middle = pitch * pitch_ + sweep(wheel_, y);
            if (wheel_.grousers > 0) { angles.push_back(middle - foot); }
            for (int column = 0; column < columns_; ++column)
            {
                angles.push_back(middle + foot + (pitch_ - 2 * foot) * column / columns_);
            }
        }
        return angles;
    }

    Ring drum_ring(double y, double radius)
    {
        Ring ring;
        ring.angles = drum_angles(y);
        for (const double angle : ring.angles) { ring.vertices.push_back(add_vertex(mesh, angle, radius, y)); }
        return ring;
    }

    /// The drum's ring with the tips of the grousers between their feet.
    Ring with_tips(const Ring& drum, double y)
    {
        const double      tip  = tip_radius(wheel_, y);
        const double      half = half_angle(wheel_, tip);
        const std::size_t each = static_cast<std::size_t>(columns_ + 1);
        Ring              ring;
        for (std::size_t i = 0; i < drum.vertices.size(); ++i)
        {
            ring.vertices.push_back(drum.vertices[i]);
            ring.angles.push_back(drum.angles[i]);
            if (i % each != 0) { continue; }
            const double middle = static_cast<double>(i / each) * pitch_ + sweep(wheel_, y);
            for (const double angle : {middle - half, middle + half})
            {
                ring.vertices.push_back(add_vertex(mesh, angle, tip, y));
                ring.angles.push_back(angle);
            }
        }
        return ring;
    }

    void tread()
    {
        Ring below;
        for (const double y : rows_)
        {
            const Ring drum = drum_ring(y, drum_radius(wheel_, y));
            const Ring row  = wheel_.grousers > 0 ? with_tips(drum, y) : drum;
            if (y == rows_.front())
            {
                left_edge_ = drum;
                grouser_ends(Side::left, row);
            }
            else { append(mesh, band(below, row)); }
            below       = row;
            right_edge_ = drum;
        }
        grouser_ends(Side::right, below);
    }

    void grouser_ends(Side side, const Ring& row)
    {
        if (wheel_.grousers == 0) { return; }
        const auto each = static_cast<std::size_t>(columns_ + 3);
        for (std::size_t first = 0; first < row.vertices.size(); first += each)
        {
            const auto at = [&](std::size_t i) { return row.vertices[(first + i) % row.vertices.size()]; };
            face(side, {{at(0), at(1), at(2)}, {at(0), at(2), at(3)}});
        }
    }

    /// From the drum's edge round the flange to where the web, or the other half of the open drum, begins.
    Ring inside(Side side)
    {
        const double edge = 0.5 * wheel_.width;
        Ring         last = side == Side::right ? right_edge_ : left_edge_;
        last              = face_inwards(side, last, edge, drum_radius(wheel_, edge), rim_radius(wheel_));

        const double flange = edge - wheel_.rim_thickness;
        const double stop   = 0.5 * wheel_.web_thickness;
        for (auto y = rows_.rbegin() + 1; *y > 0 && *y >= stop; ++y)
        {
            const bool on_flange = wheel_.rim_height > 0 && *y >= flange;
            last                 = go_on(side, last, *y, on_flange ? rim_radius(wheel_) : inner_radius(wheel_, *y));
            if (on_flange && *y == flange)
            {
                last = face_inwards(side, last, *y, rim_radius(wheel_), inner_radius(wheel_, *y));
            }
        }
        return last;
    }

    /// Plane face, with the drum's columns, from one radius to the other.
    Ring face_inwards(Side side, Ring last, double y, double from, double to)
    {
        const int steps = steps_over(std::abs(to - from), 2 * chord_);
        for (int step = 1; step <= steps; ++step)
        {
            last = go_on(side, last, y, step == steps ? to : from + (to - from) * step / steps);
        }
        return last;
    }

    Ring go_on(Side side, const Ring& last, double y, double radius)
    {
        Ring next = drum_ring(side == Side::right ? y : -y, radius);
        face(side, band(last, next));
        return next;
    }

    /// Disc from the drum to the hub, the hub's side and its face.
    void web_and_hub(Side side, Ring last)
    {
        const double sign   = side == Side::right ? 1 : -1;
        const double outer  = inner_radius(wheel_, 0.5 * wheel_.web_thickness);
        const double height = 0.5 * wheel_.web_thickness;
        const double way    = outer - wheel_.hub_radius;
        const int    steps  = steps_over(way, chord_);
        const auto   count  = [&](double radius) { return std::max(60, steps_over(2 * pi * radius, chord_)); };
        for (int step = 1; step <= steps; ++step)
        {
            const double radius = step == steps ? wheel_.hub_radius : outer - way * step / steps;
            const Ring   next   = even_ring(mesh, count(radius), last.angles.front(), radius, sign * height);
            face(side, zipped_band(last, next));
            last = next;
        }
        hub(side, last, sign);
    }

    void hub(Side side, Ring last, double sign)
    {
        const int    count = static_cast<int>(last.vertices.size());
        const double start = last.angles.front();
        const double foot = 0.5 * wheel_.web_thickness, top = 0.5 * wheel_.hub_width;
        const int    rises = steps_over(top - foot, 4 * pi * wheel_.hub_radius / count);
        for (int rise = 1; rise <= rises; ++rise)
        {
            const double y    = rise == rises ? top : foot + (top - foot) * rise / rises;
            const Ring   next = even_ring(mesh, count, start, wheel_.hub_radius, sign * y);
            face(side, band(last, next));
            last = next;
        }
        const int steps = std::max(3, steps_over(wheel_.hub_radius, 2 * chord_));
        for (int step = steps - 1; step > 0; --step)
        {
            const double part       = static_cast<double>(step) / steps;
            const int    next_count = std::max(6, static_cast<int>(std::lround(count * part)));
            const Ring   next       = even_ring(mesh, next_count, start, part * wheel_.hub_radius, sign * top);
            face(side, zipped_band(last, next));
            last = next;
        }
        face(side, fan(last, add_vertex(mesh, 0, 0, sign * top)));
    }

    /// Both sides of a wheel are made as the right one; the left one is its mirror image.
    void face(Side side, const Triangles& triangles)
    {
        append(mesh, side == Side::right ? triangles : reversed(triangles));
    }

    scene::WheelGenerator wheel_;
    std::vector<double>   rows_;    ///< y, m
    double                chord_;   ///< m
    double                pitch_;   ///< angle from grouser to grouser
    int                   columns_; ///< from one grouser's foot to the next grouser's
    Ring                  left_edge_, right_edge_;
};

} // namespace

TriangleMesh wheel_mesh(const scene::WheelGenerator& generator, const std::string& origin)
{
    check_wheel(generator, origin);
    return WheelBuilder(generator).mesh;
}

} // namespace tread::shape
