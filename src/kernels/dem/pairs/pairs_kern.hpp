#pragma once

#include <cmath>
#include <cstdint>

#include "backend/bits.hpp"
#include "kernels/dem/pairs/pairs.hpp"

namespace tread::dem
{

/// Verlet skin: displacement that a list of pairs allows a body beyond its own motion, in bounding radii, because a
/// body at rest may be set in motion. At least half of it must be left at the start of a step.
inline constexpr double search_skin = 0.003, rest_reserve = 0.5 * search_skin;

/// Number of steps of a body's motion for which a list must still be valid at the start of a step: the present step,
/// and the next, whose contacts are expected (contact_limits.hpp).
inline constexpr double steps_ahead = 2.1;

/// Upper bound of the speed of a body's points about its centre, m/s; `radius` = bounding radius, m.
TREAD_HD double rim_speed(const BodiesView& bodies, std::int64_t b, double radius)
{
    return bodies.angular_velocity[b].norm() * radius;
}

/// Upper bound of the speed of a body's points, m/s.
TREAD_HD double speed_of(const BodiesView& bodies, std::int64_t b, double radius)
{
    return bodies.velocity[b].norm() + rim_speed(bodies, b, radius);
}

TREAD_HD double bounding_radius(const BodiesView& bodies, const TemplateView* templates, std::int64_t b)
{
    return templates[bodies.shape[b]].bounding_radius * bodies.scale[b];
}

/// Displacement of any point of a body until the pairs are found again, in bounding radii.
struct SearchDisplacement
{
    double least;    ///< expected displacement over steps_ahead, plus the skin
    double per_step; ///< additional displacement for each step that a list lasts beyond the first
};

/// Upper limit of the additional displacement: the cells of the search grid are as wide as the largest search radius.
inline constexpr double most_per_step = 0.2;

/// Computes the displacement of a body with this speed among bodies with speeds up to `near` (m/s), which it may soon
/// reach.
TREAD_HD SearchDisplacement search_displacement(double radius, double speed, double near, double dt)
{
    const double a_step = radius > 0 ? dt / radius : 0.0;
    return {steps_ahead * a_step * speed + search_skin, std::fmin(a_step * near, most_per_step)};
}

/// Number of steps that a list should last beyond the first, if a step has `substeps` substeps and bodies move by
/// `mean` (bounding radii) in one step. For every radius of additional displacement a substep evaluates more nodes,
/// which takes 1 / `worth` of the time of a search; a step therefore costs substeps mean steps / worth + 1 / (1 +
/// steps) searches, and the result minimises this. Nodes also take memory, which `mean_more` limits.
TREAD_HD double steps_to_last(double mean, double substeps)
{
    constexpr double worth = 1.5, most_steps = 60, mean_more = 0.01;
    if (!(mean > 0)) { return most_steps; }
    const double cheapest = std::sqrt(worth / (substeps * mean)) - 1;
    return std::fmin(std::fmax(cheapest, 0.0), std::fmin(mean_more / mean, most_steps));
}

/// How far apart two bodies' places may come to lie that touch before the pairs are found again: their bounding radii
/// and how far they come together, m.
struct PairReach
{
    double first;
    double second;
    double approach;

    TREAD_HD double total() const { return first + second + approach; }
};

TREAD_HD PairReach pair_reach(const BodiesView& bodies, const TemplateView* templates, const AllowedMotion& allowed,
                              std::int64_t a, std::int64_t b)
{
    return {bounding_radius(bodies, templates, a), bounding_radius(bodies, templates, b),
            allowed.displacement[a] + allowed.displacement[b] + allowed.drift_of(a, b)};
}

/// Whether the bounding spheres may meet.
TREAD_HD bool may_touch(const BodiesView& bodies, const TemplateView* templates, const AllowedMotion& allowed,
                        std::int64_t a, std::int64_t b)
{
    const double together = pair_reach(bodies, templates, allowed, a, b).total();
    return (bodies.position[a] - bodies.position[b]).squaredNorm() <= together * together;
}

/// Whether the surface of body b's template can enter the other body's extended bounding sphere. Points inside the
/// interpolated surface are within its error of the true surface.
TREAD_HD bool surface_near(const BodiesView& bodies, const TemplateView* templates, std::int64_t b,
                           const Vec3<double>& centre, double reach)
{
    const TemplateView& shape = templates[bodies.shape[b]];
    const double        scale = bodies.scale[b];
    return sample_body_sdf(shape, scale, bodies.position[b], bodies.orientation[b], centre).distance <=
           bound_within(shape, scale, reach);
}

/// Whether each body's surface can enter the other's bounding sphere: most pairs whose spheres meet fail this test.
TREAD_HD bool surfaces_near(const BodiesView& bodies, const TemplateView* templates, const AllowedMotion& allowed,
                            std::int64_t a, std::int64_t b)
{
    const PairReach reach = pair_reach(bodies, templates, allowed, a, b);
    return surface_near(bodies, templates, a, bodies.position[b], reach.second + reach.approach) &&
           surface_near(bodies, templates, b, bodies.position[a], reach.first + reach.approach);
}

TREAD_HD bool may_touch_plane(const BodiesView& bodies, const TemplateView* templates, const AllowedMotion& allowed,
                              std::int64_t b, const Plane& plane)
{
    return plane.normal.dot(bodies.position[b]) - plane.offset <=
           bounding_radius(bodies, templates, b) + allowed.way_of(b);
}

/// Cells of the search grid: 21 bits per axis, x lowest, so that neighbours along x have consecutive keys.
inline constexpr std::int32_t  cell_bias = 1 << 20;
inline constexpr std::uint64_t no_cell   = ~std::uint64_t{0};

/// Returns the cell coordinate, clamped to the range of keys, because a body may be anywhere.
TREAD_HD std::int64_t cell_coordinate(double position, double size)
{
    const double cell = std::floor(position / size), limit = cell_bias - 2;
    return static_cast<std::int64_t>(std::fmin(std::fmax(cell, -limit), limit)) + cell_bias;
}

TREAD_HD std::uint64_t cell_key_of(std::int64_t x, std::int64_t y, std::int64_t z)
{
    return static_cast<std::uint64_t>(z << 42 | y << 21 | x);
}

/// Returns the body whose owner evaluates the pair a < b if there are several ranks: the second body, or the small one
/// of a small and a large body, because a large one may be near many ranks.
TREAD_HD std::int64_t decider_of(const std::int32_t* is_large, std::int64_t a, std::int64_t b)
{
    return is_large[b] > is_large[a] ? a : b;
}

/// Finds the pairs of one body; each pair is found from only one of its two bodies, one of an awake and a sleeping body
/// from the awake one. Two sleepers have no pair. The search is split into parts, so that few bodies fill a device.
struct PairSearch
{
    BodiesView           bodies;
    BodyLaw              law;
    AllowedMotion        allowed;
    double               cell_size; ///< m, at least twice the maximum search radius in the grid
    const std::uint64_t* cell_key;  ///< ascending
    const std::int32_t*  cell_body; ///< every body, those in the grid in the order of their cells
    const SearchSphere*  sphere;    ///< of the bodies of cell_body
    const std::int32_t*  large;
    std::int64_t         large_count;
    const std::int32_t*  is_large;
    const std::uint64_t* jointed; ///< keys of pairs that never touch, ascending
    std::int64_t         jointed_count;

    TREAD_HD bool is_sphere(std::int64_t b) const { return law.templates[bodies.shape[b]].sphere_radius > 0; }

    TREAD_HD bool answered_here(std::int64_t a, std::int64_t b) const
    {
        return bodies.is_owned(decider_of(is_large, a, b)) && bodies.is_here(a) && bodies.is_here(b);
    }

    /// Whether two bodies may touch; the bounding sphere of an exact sphere is its surface. a < b.
    TREAD_HD bool near(std::int64_t a, std::int64_t b) const
    {
        return may_touch(bodies, law.templates, allowed, a, b) &&
               law.pairs(bodies.material[a], bodies.material[b]).touch &&
               find_sorted(jointed, jointed_count, pair_key(a, b)) < 0 &&
               ((is_sphere(a) && is_sphere(b)) || surfaces_near(bodies, law.templates, allowed, a, b));
    }

    TREAD_HD bool near(std::int64_t b, const Plane& plane) const
    {
        return may_touch_plane(bodies, law.templates, allowed, b, plane) &&
               law.pairs(bodies.material[b], law.pairs.wall()).touch;
    }

    /// Parts of a body's search: the rows of cells around its own cell, and everything that is not in the cell grid.
    static constexpr std::int64_t cell_rows = 9, parts = cell_rows + 1;

    /// One part of the search of the body at a place of cell_body.
    struct Part
    {
        std::int64_t place;
        std::int64_t part;
    };

    /// Number of bodies, one after the other in cell_body, whose parts have numbers one after the other, too: a warp
    /// looks for all of them through much the same row.
    static constexpr std::int64_t together = 32;

    TREAD_HD std::int64_t part_count() const { return (bodies.count + together - 1) / together * together * parts; }

    /// Returns the part with a number in [0, part_count); some have no body.
    TREAD_HD static Part part_of(std::int64_t i)
    {
        const std::int64_t group = i / (together * parts);
        return {group * together + i % together, i / together % parts};
    }

    TREAD_HD bool has_body(const Part& part) const { return part.place < bodies.count; }

    /// Calls visit(key) for each pair that may touch.
    template<class Visit>
    TREAD_HD void operator()(const Part& part, Visit visit) const
    {
        each_candidate(part,
                       [&](std::uint64_t pair, const auto& is_near)
                       {
                           if (is_near()) { visit(pair); }
                       });
    }

    /// Calls visit(key, is_near) for each pair that is not ruled out at once, in the same order each time; is_near()
    /// tells whether it may touch.
    template<class Visit>
    TREAD_HD void each_candidate(const Part& part, Visit visit) const
    {
        if (!has_body(part)) { return; }
        const std::int64_t a = cell_body[part.place];
        if (!bodies.is_here(a)) { return; }
        if (part.part == cell_rows) { beside_cells(a, visit); }
        else if (is_large[a] == 0 && !bodies.is_asleep(a)) { in_row(part.place, part.part, visit); }
    }

private:
    /// Whether the pair of these bodies in the grid is found from the first of them, which is awake.
    TREAD_HD bool found_from(std::int64_t a, std::int64_t b) const { return b > a || (b < a && bodies.is_asleep(b)); }

    template<class Visit>
    TREAD_HD void in_row(std::int64_t place, std::int64_t row, Visit& visit) const
    {
        const SearchSphere own      = sphere[place];
        const std::int64_t a        = cell_body[place];
        const std::int64_t x        = cell_coordinate(own.centre[0], cell_size),
                           y        = cell_coordinate(own.centre[1], cell_size) + row % 3 - 1,
                           z        = cell_coordinate(own.centre[2], cell_size) + row / 3 - 1;
        const std::int64_t  gridded = bodies.count - large_count;
        const std::uint64_t last    = cell_key_of(x + 1, y, z);
        std::int64_t        i       = lower_bound(cell_key, gridded, cell_key_of(x - 1, y, z));
        while (i < gridded && cell_key[i] <= last)
        {
            // All threads of a warp test spheres, and then all test pairs.
            const std::int64_t begin = i;
            std::uint32_t      met   = 0;
            for (; i < begin + 32 && i < gridded && cell_key[i] <= last; ++i)
            {
                const bool meets = found_from(a, cell_body[i]) && own.meets(sphere[i]);
                met |= std::uint32_t{meets} << (i - begin);
            }
            for (; met != 0; met &= met - 1) { visit_pair(a, cell_body[begin + lowest_bit(met)], visit); }
        }
    }

    /// Visits pairs with large bodies and walls.
    template<class Visit>
    TREAD_HD void beside_cells(std::int64_t a, Visit& visit) const
    {
        for (std::int64_t l = 0; l < large_count; ++l)
        {
            const std::int64_t b = large[l];
            if ((is_large[a] != 0 && b <= a) || (bodies.is_asleep(a) && bodies.is_asleep(b))) { continue; }
            visit_pair(a, b, visit);
        }
        for (std::int32_t p = 0; p < law.plane_count; ++p)
        {
            if (!bodies.is_owned(a) || bodies.is_asleep(a)) { continue; }
            visit(pair_key(a, bodies.count + p), [&] { return near(a, law.planes[p]); });
        }
    }

    template<class Visit>
    TREAD_HD void visit_pair(std::int64_t a, std::int64_t b, Visit& visit) const
    {
        const std::int64_t first = a < b ? a : b, second = a < b ? b : a;
        visit(pair_key(first, second), [&] { return answered_here(first, second) && near(first, second); });
    }
};

} // namespace tread::dem
