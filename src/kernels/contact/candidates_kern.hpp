#pragma once

#include <cmath>
#include <cstdint>

#include "kernels/contact/candidates.hpp"
#include "kernels/contact/samples_kern.hpp"
#include "kernels/dem/contact/sdf_kern.hpp"
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

/// Data of a body for the search.
struct SearchBody
{
    const dem::TemplateView* shape;
    double                   scale;
    Vec3<double>             position;
    Quat                     orientation;
    double approach; ///< m, twice the possible one in the step, or the skin, plus twice the samples' extent
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
    return {shape, bodies.scale[b], bodies.position[b], bodies.orientation[b], nearer + 2.0 * patch};
}

/// Returns the pages of a level whose points may be candidates of the body: those that overlap its extended
/// axis-aligned box.
TREAD_HD PageBox page_box(const SearchBody& body, const mpm::PagesView& pages, int level, const SearchReach& reach)
{
    const Mat3<double> rotation = body.orientation.toRotationMatrix();
    const Vec3<double> centre   = body.position + rotation * (0.5 * body.scale * (body.shape->low + body.shape->high));
    const Vec3<double> half     = rotation.cwiseAbs() * (0.5 * body.scale * (body.shape->high - body.shape->low));
    const double       margin   = reach.largest_radius + reach.point_drift + body.approach;

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
    const Vec3<double> grown = half + Vec3<double>::Constant(margin);
    return {page_at(centre - grown), page_at(centre + grown)};
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
