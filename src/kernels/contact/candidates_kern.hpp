#pragma once

#include <cmath>
#include <cstdint>

#include "kernels/contact/candidates.hpp"
#include "kernels/contact/samples_kern.hpp"
#include "kernels/dem/contact/sdf_kern.hpp"
#include "kernels/dem/pairs/displacement_kern.hpp"
#include "kernels/mpm/grid/levels.hpp"
#include "kernels/mpm/pages/page_lattice.hpp"

namespace tread::contact
{

/// Box of pages, both ends included.
struct PageBox
{
    mpm::Index3 low;
    mpm::Index3 high;

    TREAD_HD std::int64_t pages() const
    {
        return static_cast<std::int64_t>(high.x - low.x + 1) * (high.y - low.y + 1) * (high.z - low.z + 1);
    }

    TREAD_HD bool contains(const mpm::Index3& page) const
    {
        return page.x >= low.x && page.x <= high.x && page.y >= low.y && page.y <= high.y && page.z >= low.z &&
               page.z <= high.z;
    }

    /// Returns page `i` of the box, x fastest.
    TREAD_HD mpm::Index3 page(std::int64_t i) const
    {
        const std::int64_t nx = high.x - low.x + 1, ny = high.y - low.y + 1;
        return {low.x + static_cast<std::int32_t>(i % nx), low.y + static_cast<std::int32_t>(i / nx % ny),
                low.z + static_cast<std::int32_t>(i / (nx * ny))};
    }
};

/// A box of the cells of a page, both ends included, 0 to page_edge - 1.
struct PageCells
{
    mpm::Index3 low;
    mpm::Index3 high;

    TREAD_HD std::int32_t cells() const { return (high.x - low.x + 1) * (high.y - low.y + 1) * (high.z - low.z + 1); }

    /// Returns the place in its page of cell `i` of the box, x fastest as places are.
    TREAD_HD std::int32_t place(std::int32_t i) const
    {
        const std::int32_t nx = high.x - low.x + 1, ny = high.y - low.y + 1;
        return low.x + i % nx + mpm::page_edge * (low.y + i / nx % ny + mpm::page_edge * (low.z + i / (nx * ny)));
    }

    TREAD_HD std::int32_t packed() const
    {
        return low.x | low.y << 2 | low.z << 4 | high.x << 6 | high.y << 8 | high.z << 10;
    }

    TREAD_HD static PageCells unpacked(std::int32_t box)
    {
        return {{box & 3, box >> 2 & 3, box >> 4 & 3}, {box >> 6 & 3, box >> 8 & 3, box >> 10}};
    }
};
static_assert(mpm::page_edge == 4, "two bits a coordinate");

/// Data of a body for the search.
struct SearchBody
{
    const dem::TemplateView* shape;
    double                   scale;
    Vec3<double>             position;
    Quat                     orientation;
    double approach; ///< m, twice the possible one in the step, or the skin, plus what find_candidates adds twice
};

TREAD_HD SearchBody search_body(const dem::BodiesView& bodies, const dem::TemplateView* templates, std::int64_t b,
                                const SearchReach& reach)
{
    const dem::TemplateView* shape  = templates + bodies.shape[b];
    const double             radius = shape->bounding_radius * bodies.scale[b];
    const double speed   = bodies.velocity[b].norm() + bodies.angular_velocity[b].norm() * radius + reach.point_speed;
    const bool   sampled = takes_samples(*shape, bodies.scale[b], reach.sampled_below);
    const double patch   = sampled ? patch_reach * reach.largest_radius : 0.0;
    const double nearer  = std::fmax(2.0 * reach.dt * speed, reach.skin);
    const double listed  = dem::way_to_come(bodies, b, reach.listed, radius);
    return {shape, bodies.scale[b], bodies.position[b], bodies.orientation[b], nearer + 2.0 * (listed + patch)};
}

/// Axis-aligned box, m, of the positions whose points may be candidates of a body.
struct GrownBox
{
    Vec3<double> low;
    Vec3<double> high;
};

TREAD_HD GrownBox grown_box(const SearchBody& body, const SearchReach& reach)
{
    const Mat3<double> rotation = body.orientation.toRotationMatrix();
    const Vec3<double> centre   = body.position + rotation * (0.5 * body.scale * (body.shape->low + body.shape->high));
    const Vec3<double> half     = rotation.cwiseAbs() * (0.5 * body.scale * (body.shape->high - body.shape->low));
    const double       margin   = reach.largest_radius + reach.point_drift + body.approach;
    const Vec3<double> grown    = half + Vec3<double>::Constant(margin);
    return {centre - grown, centre + grown};
}

/// Returns the pages of a level whose points may be candidates of the body: those that overlap its grown box.
TREAD_HD PageBox page_box(const SearchBody& body, const mpm::PagesView& pages, int level, const SearchReach& reach)
{
    const mpm::Lattice lattice = mpm::level_lattice(pages, level);
    const double       shift   = lattice.stencil_shift + lattice.node_shift;
    const double       low     = level == 0 ? -(mpm::page_bias - 1) : level << mpm::level_bits;
    const double       high    = pages.levels == 0 ? mpm::page_bias - 1 : ((level + 1) << mpm::level_bits) - 1;
    const auto         page_at = [&](const Vec3<double>& x) -> mpm::Index3
    {
        return {mpm::page_coordinate(x[0], lattice.spacing, shift, low, high),
                mpm::page_coordinate(x[1], lattice.spacing, shift, low, high),
                mpm::page_coordinate(x[2], lattice.spacing, shift, low, high)};
    };
    const GrownBox box = grown_box(body, reach);
    return {page_at(box.low), page_at(box.high)};
}

/// Returns the cells of a page whose points may be candidates of the body: those that overlap its grown box. The page
/// is one of its page_box.
TREAD_HD PageCells cell_box(const SearchBody& body, const mpm::PagesView& pages, std::int64_t page,
                            const SearchReach& reach)
{
    const mpm::Index3  corner  = mpm::page_coordinates(pages.point_page_key[page]);
    const mpm::Lattice lattice = mpm::level_lattice(pages, mpm::level_of(corner));
    const double       shift   = lattice.stencil_shift + lattice.node_shift;
    const auto         cell    = [&](double position, std::int32_t page_coordinate)
    {
        const double local = std::floor(position / lattice.spacing - shift) - page_coordinate * mpm::page_edge;
        return static_cast<std::int32_t>(std::fmin(std::fmax(local, 0.0), mpm::page_edge - 1));
    };
    const auto cell_at = [&](const Vec3<double>& x) -> mpm::Index3 {
        return {cell(x[0], corner.x), cell(x[1], corner.y), cell(x[2], corner.z)};
    };
    const GrownBox box = grown_box(body, reach);
    return {cell_at(box.low), cell_at(box.high)};
}

/// Number of page lookups for a box: its own pages, or all pages with points if these are fewer.
TREAD_HD std::int64_t lookups(const PageBox& box, std::int64_t point_pages)
{
    const std::int64_t own = box.pages();
    return own < point_pages ? own : point_pages;
}

/// Number of lookups on all levels for a body.
TREAD_HD std::int64_t lookups(const SearchBody& body, const mpm::PagesView& pages, const SearchReach& reach)
{
    std::int64_t count = 0;
    for (int level = 0; level <= pages.levels; ++level)
    {
        count += lookups(page_box(body, pages, level, reach), pages.point_pages);
    }
    return count;
}

/// Returns the point page of lookup `i` of the box, or -1.
TREAD_HD std::int64_t lookup_page(const PageBox& box, const mpm::PagesView& pages, std::int64_t i)
{
    if (box.pages() < pages.point_pages)
    {
        return find_sorted(pages.point_page_key, pages.point_pages, mpm::page_key(box.page(i)));
    }
    return box.contains(mpm::page_coordinates(pages.point_page_key[i])) ? i : -1;
}

/// Returns the point page of lookup `i` on all levels for a body, or -1.
TREAD_HD std::int64_t lookup_page(const SearchBody& body, const mpm::PagesView& pages, const SearchReach& reach,
                                  std::int64_t i)
{
    for (int level = 0; level < pages.levels; ++level)
    {
        const PageBox      box = page_box(body, pages, level, reach);
        const std::int64_t own = lookups(box, pages.point_pages);
        if (i < own) { return lookup_page(box, pages, i); }
        i -= own;
    }
    return lookup_page(page_box(body, pages, pages.levels, reach), pages, i);
}

/// Whether x is in the body-frame bounding box, extended by `margin` along each of the body's axes.
TREAD_HD bool in_grown_box(const SearchBody& body, const Vec3<double>& x, double margin)
{
    const Vec3<double> local = body.orientation.conjugate() * Vec3<double>(x - body.position);
    for (int c = 0; c < 3; ++c)
    {
        if (local[c] < body.scale * body.shape->low[c] - margin || local[c] > body.scale * body.shape->high[c] + margin)
        {
            return false;
        }
    }
    return true;
}

/// Whether any position in a cell can be inside the body's extended box.
TREAD_HD bool cell_may_touch(const SearchBody& body, const mpm::PagesView& pages, std::int64_t page, int place,
                             const SearchReach& reach)
{
    const mpm::Index3  corner = mpm::page_coordinates(pages.point_page_key[page]);
    const Vec3<double> cell(corner.x * mpm::page_edge + (place & 3), corner.y * mpm::page_edge + (place >> 2 & 3),
                            corner.z * mpm::page_edge + (place >> 4));
    const mpm::Lattice lattice = mpm::level_lattice(pages, mpm::level_of(corner));
    const double       shift   = lattice.stencil_shift + lattice.node_shift + 0.5;
    const Vec3<double> centre  = lattice.spacing * (cell + Vec3<double>::Constant(shift));
    const double       corners = std::sqrt(3.0) * (0.5 * lattice.spacing + reach.point_drift);
    return in_grown_box(body, centre, corners + reach.largest_radius + body.approach);
}

/// Whether a point of radius `radius` at x can touch the body within the step.
TREAD_HD bool may_touch(const SearchBody& body, const Vec3<double>& x, double radius)
{
    return in_grown_box(body, x, radius + body.approach) &&
           dem::sample_body_sdf(*body.shape, body.scale, body.position, body.orientation, x).distance <=
               dem::search_bound(*body.shape, body.scale, radius, body.approach);
}

} // namespace tread::contact
