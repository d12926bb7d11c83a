#include "solver/sand/point_order.hpp"

#include "backend/instantiate.hpp"

namespace tread::solver
{
namespace
{

/// Relistings after which points are sorted in memory: scattered points of a cell cost memory reads.
constexpr int relists_an_order = 32;

} // namespace

template<class Exec, class Real>
PointOrder<Exec, Real>::PointOrder(const Exec& exec)
    : pages(exec)
    , scratch(exec)
    , relist_scratch(exec)
    , moves_to(exec, "point moves")
    , move_counts(exec, "page moves")
    , changed_in(exec, "last step with moves", 1)
{
    changed_in.fill_zero();
}

template<class Exec, class Real>
OrderDue order_due(const PointOrder<Exec, Real>& order, std::int64_t unreported)
{
    if (unreported > 0) { return OrderDue::relist; }
    switch (order.cell_change)
    {
    case mpm::CellChange::none:
        return OrderDue::nothing;
    case mpm::CellChange::moved:
        return OrderDue::renew;
    default:
        return OrderDue::sort;
    }
}

template<class Exec, class Real>
void relist(const Exec& exec, PointOrder<Exec, Real>& order)
{
    mpm::relist_points(exec, order.pages, order.moves(), order.relist_scratch, order.scratch.keys);
    ++order.relists;
}

template<class Exec, class Real>
void renew_if_scattered(const Exec& exec, PointOrder<Exec, Real>& order, mpm::Points<Exec, Real>& points)
{
    if (order.relists < relists_an_order) { return; }
    mpm::renew_order(exec, points, order.pages, order.scratch);
    order.relists = 0;
    ++order.reorder_count;
}

template<class Exec, class Real>
void resize_moves(PointOrder<Exec, Real>& order, std::int64_t count)
{
    order.moves_to.resize(count);
    order.move_counts.resize(order.pages.point_page_key.size() * mpm::move_counts);
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template struct PointOrder<Exec, Real>;                                                                            \
    template OrderDue order_due(const PointOrder<Exec, Real>&, std::int64_t);                                          \
    template void     relist(const Exec&, PointOrder<Exec, Real>&);                                                    \
    template void     renew_if_scattered(const Exec&, PointOrder<Exec, Real>&, mpm::Points<Exec, Real>&);              \
    template void     resize_moves(PointOrder<Exec, Real>&, std::int64_t)
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
