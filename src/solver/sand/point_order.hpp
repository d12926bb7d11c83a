#pragma once

#include "kernels/mpm/pages/order.hpp"
#include "kernels/mpm/pages/relist.hpp"

namespace tread::solver
{

/// Lists of a rank's points by page and cell, the points' moves in the last step, and when the lists must be renewed.
template<class Exec, class Real>
struct PointOrder
{
    explicit PointOrder(const Exec& exec);

    /// Where the points move in the step of number `step`.
    mpm::MovesView moves() { return {moves_to.data(), move_counts.data(), changed_in.data(), step}; }

    mpm::Pages<Exec>              pages;
    mpm::OrderScratch<Exec, Real> scratch;
    mpm::RelistScratch<Exec>      relist_scratch;
    Array<Exec, std::uint16_t>    moves_to;                              ///< [points], MovesView::to
    Array<Exec, std::int32_t>     move_counts;                           ///< [point pages][mpm::move_counts]
    Array<Exec, std::int64_t>     changed_in;                            ///< [1], MovesView::changed_in
    mpm::CellChange               cell_change   = mpm::CellChange::lost; ///< up to the last report
    bool                          listed        = false;                 ///< points were listed since the last step
    int                           relists       = 0;                     ///< relistings since the last sort in memory
    std::int64_t                  step          = 0;                     ///< number of the last step
    std::int64_t                  reorder_count = 0; ///< a change invalidates indices into point arrays
    std::int64_t                  migrated      = 0; ///< points of all ranks that changed rank in the last listing
};

/// Work on the lists that is due before the next step.
enum class OrderDue
{
    nothing, ///< the lists are valid
    relist,  ///< points may have changed their cells since the last report
    renew,   ///< points changed their cells: relist them, and sort them in memory after many relistings
    sort,    ///< a point approaches pages that are not listed: sort the points and rebuild the pages
};

/// Says what is due after `unreported` steps since the last report; the points must not be listed yet.
template<class Exec, class Real>
OrderDue order_due(const PointOrder<Exec, Real>& order, std::int64_t unreported);

/// Lists the points in the cells to which they moved, without synchronisation.
template<class Exec, class Real>
void relist(const Exec& exec, PointOrder<Exec, Real>& order);

/// Sorts the points in memory into the order of the list if they were relisted often, without synchronisation.
template<class Exec, class Real>
void renew_if_scattered(const Exec& exec, PointOrder<Exec, Real>& order, mpm::Points<Exec, Real>& points);

/// Allocates the moves of `count` points.
template<class Exec, class Real>
void resize_moves(PointOrder<Exec, Real>& order, std::int64_t count);

} // namespace tread::solver
