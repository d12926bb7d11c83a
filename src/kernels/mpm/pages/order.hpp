#pragma once

#include <vector>

#include "backend/sort.hpp"
#include "kernels/mpm/grid/levels.hpp"
#include "kernels/mpm/points.hpp"

namespace tread::mpm
{

/// Geometry of the grid: spacing, domain and walls.
struct GridGeometry
{
    double       spacing;       ///< m
    double       stencil_shift; ///< cell = floor(x / spacing - stencil_shift): 0.5 quadratic, 0 linear
    Vec3<double> size;          ///< m; the domain is [0, size]
    Refinement   refinement{};

    TREAD_HD Lattice lattice() const { return make_lattice(spacing, stencil_shift); }

    /// Returns the spacing of the last level, m.
    TREAD_HD double finest_spacing() const { return level_lattice(lattice(), refinement.levels).spacing; }
};

/// Scratch memory of order_points, kept between calls.
template<class Exec, class Real>
struct OrderScratch
{
    explicit OrderScratch(const Exec& exec)
        : sort(exec)
        , keys(exec, "order keys")
        , order(exec, "order")
        , neighbour_keys(exec, "order neighbour keys")
        , neighbour_order(exec, "order neighbour order")
    {
    }

    SortScratch<Exec>          sort;
    Array<Exec, std::uint64_t> keys;
    Array<Exec, std::int32_t>  order;
    Array<Exec, std::uint64_t> neighbour_keys;
    Array<Exec, std::int32_t>  neighbour_order;
};

/// Orders points in memory by page and cell, stably, and rebuilds the page tables. Points more than two cells outside
/// the domain are dropped (points.count decreases): returns their number, and until points are added they remain in
/// memory behind the others. Postconditions: every point is listed in the range of its cell; the list is the order in
/// memory; page keys ascend; every page within two cells of a point is listed.
template<class Exec, class Real>
std::int64_t order_points(const Exec& exec, Points<Exec, Real>& points, Pages<Exec>& pages,
                          const GridGeometry& geometry, OrderScratch<Exec, Real>& scratch);

/// Moves the points in memory into the order of the list; lists and tables of pages are unchanged.
template<class Exec, class Real>
void renew_order(const Exec& exec, Points<Exec, Real>& points, Pages<Exec>& pages, OrderScratch<Exec, Real>& scratch);

/// Replaces the list of node pages: `keys` ascend and include the present ones.
template<class Exec>
void set_node_pages(const Exec& exec, Pages<Exec>& pages, const std::vector<std::uint64_t>& keys);

} // namespace tread::mpm
