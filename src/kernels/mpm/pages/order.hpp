#pragma once

#include <vector>

#include "backend/sort.hpp"
#include "kernels/mpm/grid/levels.hpp"
#include "kernels/mpm/points.hpp"

namespace tread::mpm
{

/// Where cells and walls are.
struct GridGeometry
{
    double       spacing;       ///< m
    double       stencil_shift; ///< cell = floor(x / spacing - stencil_shift): 0.5 quadratic, 0 linear
    Vec3<double> size;          ///< m; the domain is [0, size]
    Refinement   refinement{};

    TREAD_HD Lattice lattice() const { return make_lattice(spacing, stencil_shift); }

    /// m, on the last level.
    TREAD_HD double finest_spacing() const { return level_lattice(lattice(), refinement.levels).spacing; }
};

/// Scratch of order_points, kept between calls.
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
/// the domain are dropped (points.count shrinks): how many comes back, and until points are added they stand behind the
/// others. Post: every point is listed in the range of its cell;
/// the list is the order in memory; page keys ascend; every page within two cells of a point is
/// listed.
template<class Exec, class Real>
std::int64_t order_points(const Exec& exec, Points<Exec, Real>& points, Pages<Exec>& pages,
                          const GridGeometry& geometry, OrderScratch<Exec, Real>& scratch);

/// Moves the points in memory to where the list has them; lists and tables of pages stay.
template<class Exec, class Real>
void renew_order(const Exec& exec, Points<Exec, Real>& points, Pages<Exec>& pages, OrderScratch<Exec, Real>& scratch);

/// Lists other node pages: `keys` ascend and include those that there are.
template<class Exec>
void set_node_pages(const Exec& exec, Pages<Exec>& pages, const std::vector<std::uint64_t>& keys);

} // namespace tread::mpm
