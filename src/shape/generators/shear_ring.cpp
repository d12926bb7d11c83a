#include "shape/generators/shear_ring.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "shape/generators/rings.hpp"
#include "shape/generators/wheel_form.hpp"

namespace tread::shape
{
namespace
{

constexpr int most_levels = 16; ///< a thousand vanes may have that many levels

/// Builds the mesh about the y axis, along which the ring is high. Columns of all rings follow the vanes.
class VanedRing
{
public:
    explicit VanedRing(const scene::RingGenerator& ring)
        : ring_(ring)
        , low_(-0.5 * ring.height)
        , high_(0.5 * ring.height)
        , pitch_(2 * std::numbers::pi / ring.vanes)
        , foot_columns_(steps_over(2 * half_angle(ring.inner_radius), longest_wheel_chord))
        , gap_columns_(steps_over(pitch_ - 2 * half_angle(ring.outer_radius), longest_wheel_chord))
        , levels_(std::min(rows_over(ring.vane_height), most_levels))
    {
    }

    TriangleMesh mesh()
    {
        const double inner = ring_.inner_radius, outer = ring_.outer_radius;
        const int    rows       = rows_over(outer - inner);
        const Ring   first      = underside(inner);
        const Ring   inner_edge = vane_ends(first, inner, Face::inwards);
        Ring         last       = first;
        for (int row = 1; row <= rows; ++row)
        {
            const Ring next = underside(row == rows ? outer : inner + (outer - inner) * row / rows);
            append(mesh_, band(last, next));
            last = next;
        }
        last = vane_ends(last, outer, Face::outwards);
        last = side(last, outer, low_, high_);
        for (int row = 1; row <= rows; ++row)
        {
            const Ring next = plain(row == rows ? inner : outer - (outer - inner) * row / rows, high_);
            append(mesh_, band(last, next));
            last = next;
        }
        const int steps = rows_over(high_ - low_);
        for (int step = 1; step < steps; ++step)
        {
            const Ring next = plain(inner, high_ - (high_ - low_) * step / steps);
            append(mesh_, band(last, next));
            last = next;
        }
        append(mesh_, band(last, inner_edge));
        stand_upright(mesh_);
        return std::move(mesh_);
    }

private:
    enum class Face
    {
        inwards,
        outwards
    };

    double half_angle(double radius) const { return std::asin(0.5 * ring_.vane_thickness / radius); }

    int rows_over(double way) const
    {
        return std::min(steps_over(way, 2 * longest_wheel_chord * ring_.outer_radius), most_rows);
    }

    /// Angle of a column across a vane's foot; columns of all radii are parallel.
    double foot_angle(int vane, int column, double radius) const
    {
        const double aside = ring_.vane_thickness * (static_cast<double>(column) / foot_columns_ - 0.5);
        return vane * pitch_ + std::asin(aside / radius);
    }

    double gap_angle(int vane, int column, double radius) const
    {
        const double half = half_angle(radius);
        return vane * pitch_ + half + (pitch_ - 2 * half) * column / gap_columns_;
    }

    void add(Ring& ring, double angle, double radius, double height)
    {
        ring.angles.push_back(angle);
        ring.vertices.push_back(add_vertex(mesh_, angle, radius, height));
    }

    double level_height(int level) const { return low_ - ring_.vane_height * level / levels_; }

    /// Ring at one radius of the lower face: down each vane, across its tip, up, and along the gap to the next.
    Ring underside(double radius)
    {
        Ring ring;
        for (int vane = 0; vane < ring_.vanes; ++vane)
        {
            for (int l = 0; l < levels_; ++l) { add(ring, foot_angle(vane, 0, radius), radius, level_height(l)); }
            for (int c = 0; c <= foot_columns_; ++c)
            {
                add(ring, foot_angle(vane, c, radius), radius, level_height(levels_));
            }
            for (int l = levels_ - 1; l >= 0; --l)
            {
                add(ring, foot_angle(vane, foot_columns_, radius), radius, level_height(l));
            }
            for (int c = 1; c < gap_columns_; ++c) { add(ring, gap_angle(vane, c, radius), radius, low_); }
        }
        return ring;
    }

    /// Ring without vanes, with their columns.
    Ring plain(double radius, double height)
    {
        Ring ring;
        for (int vane = 0; vane < ring_.vanes; ++vane)
        {
            for (int c = 0; c < foot_columns_; ++c) { add(ring, foot_angle(vane, c, radius), radius, height); }
            for (int c = 0; c < gap_columns_; ++c) { add(ring, gap_angle(vane, c, radius), radius, height); }
        }
        return ring;
    }

    /// Appends a cylinder from a ring at height `from` up to `to`; returns its last ring.
    Ring side(Ring last, double radius, double from, double to)
    {
        const int steps = rows_over(to - from);
        for (int step = 1; step <= steps; ++step)
        {
            const Ring next = plain(radius, step == steps ? to : from + (to - from) * step / steps);
            append(mesh_, band(last, next));
            last = next;
        }
        return last;
    }

    /// Vertices across a vane's end at one level, taken from a ring of the underside that starts the vane at `first`,
    /// or made.
    std::vector<std::int32_t> across(const Ring& under, std::size_t first, int vane, int level, double radius)
    {
        const auto                taken = [&](int at) { return under.vertices[first + static_cast<std::size_t>(at)]; };
        std::vector<std::int32_t> line;
        for (int c = 0; c <= foot_columns_; ++c)
        {
            if (level == levels_ || c == 0) { line.push_back(taken(level + c)); }
            else if (c == foot_columns_) { line.push_back(taken(2 * levels_ + foot_columns_ - level)); }
            else { line.push_back(add_vertex(mesh_, foot_angle(vane, c, radius), radius, level_height(level))); }
        }
        return line;
    }

    /// Closes the vanes' ends at one radius and returns the ring along their feet and the gaps.
    Ring vane_ends(const Ring& under, double radius, Face facing)
    {
        const auto each = under.vertices.size() / static_cast<std::size_t>(ring_.vanes);
        const auto over = static_cast<std::size_t>(2 * levels_ + foot_columns_ + 1);
        Ring       edge;
        for (int vane = 0; vane < ring_.vanes; ++vane)
        {
            const std::size_t         first = each * static_cast<std::size_t>(vane);
            std::vector<std::int32_t> below = across(under, first, vane, levels_, radius);
            for (int level = levels_ - 1; level >= 0; --level)
            {
                const std::vector<std::int32_t> above = across(under, first, vane, level, radius);
                Triangles                       strip;
                for (std::size_t i = 0; i + 1 < below.size(); ++i)
                {
                    strip.push_back({below[i], below[i + 1], above[i + 1]});
                    strip.push_back({below[i], above[i + 1], above[i]});
                }
                append(mesh_, facing == Face::outwards ? strip : reversed(strip));
                below = above;
            }
            edge.vertices.insert(edge.vertices.end(), below.begin(), below.end());
            for (int c = 0; c <= foot_columns_; ++c) { edge.angles.push_back(foot_angle(vane, c, radius)); }
            for (std::size_t i = over; i < each; ++i)
            {
                edge.vertices.push_back(under.vertices[first + i]);
                edge.angles.push_back(under.angles[first + i]);
            }
        }
        return edge;
    }

    const scene::RingGenerator& ring_;
    TriangleMesh                mesh_;
    double                      low_, high_, pitch_;
    int                         foot_columns_, gap_columns_, levels_;
};

} // namespace

TriangleMesh vaned_ring(const scene::RingGenerator& ring) { return VanedRing(ring).mesh(); }

} // namespace tread::shape
