#pragma once

#include "kernels/mpm/pages/leaving.hpp"
#include "kernels/mpm/pages/order_impl.hpp"

// Steps of find_leaving and remove_leaving, for both backends; leaving.cpp and leaving.cu provide for_each and
// instantiate.
namespace tread::mpm
{

/// Marks the leaving points by their keys (order_steps::MakeKeys).
struct MarkLeaving
{
    const std::uint64_t* keys;
    PageOwnersView       owners;
    std::int32_t         self;
    std::int32_t*        owner;
    std::int32_t*        mark;

    TREAD_HD void operator()(std::int64_t i) const
    {
        owner[i] = keys[i] == no_page ? self : owners.of(keys[i] >> 6);
        mark[i]  = owner[i] != self;
    }
};

/// Writes the leaving points; after the scan before[i] is the number of leaving points before i.
struct WriteLeaving
{
    const std::uint64_t* keys;
    const std::int32_t*  owner_of;
    const std::int32_t*  before;
    std::int32_t         self;
    std::int32_t*        row;
    std::int32_t*        owner;
    std::uint64_t*       page;

    TREAD_HD void operator()(std::int64_t i) const
    {
        if (owner_of[i] == self) { return; }
        row[before[i]]   = static_cast<std::int32_t>(i);
        owner[before[i]] = owner_of[i];
        page[before[i]]  = keys[i] >> 6;
    }
};

/// Writes point i to the order of the staying points, if it stays; `row` ascends.
struct WriteStaying
{
    const std::int32_t* row;
    std::int64_t        rows;
    std::int32_t*       order;

    TREAD_HD void operator()(std::int64_t i) const
    {
        const std::int64_t before = lower_bound(row, rows, static_cast<std::int32_t>(i));
        if (before == rows || row[before] != i) { order[i - before] = static_cast<std::int32_t>(i); }
    }
};

template<class Exec, class Real>
void find_leaving(const Exec& exec, Points<Exec, Real>& points, const GridGeometry& geometry,
                  const PageOwnersView& owners, std::int32_t self, Leaving<Exec>& leaving,
                  OrderScratch<Exec, Real>& scratch)
{
    const std::int64_t n = points.count;
    scratch.keys.resize(n);
    scratch.order.resize(n);
    leaving.mark.resize(n);
    for_each(exec, "point keys", n,
             order_steps::MakeKeys<Real>{points.view(), geometry, scratch.keys.data(), scratch.order.data()});
    for_each(exec, "mark leaving points", n,
             MarkLeaving{scratch.keys.data(), owners, self, scratch.order.data(), leaving.mark.data()});
    const std::int64_t count = exclusive_scan(exec, leaving.mark, scratch.sort);
    leaving.row.resize(count);
    leaving.owner.resize(count);
    leaving.page.resize(count);
    if (count == 0) { return; }
    for_each(exec, "write leaving points", n,
             WriteLeaving{scratch.keys.data(), scratch.order.data(), leaving.mark.data(), self, leaving.row.data(),
                          leaving.owner.data(), leaving.page.data()});
}

template<class Exec, class Real>
void remove_leaving(const Exec& exec, Points<Exec, Real>& points, const Leaving<Exec>& leaving,
                    OrderScratch<Exec, Real>& scratch)
{
    if (leaving.row.size() == 0) { return; }
    scratch.order.resize(points.count);
    for_each(exec, "write staying points", points.count,
             WriteStaying{leaving.row.data(), leaving.row.size(), scratch.order.data()});
    points.count -= leaving.row.size();
    gather_points(exec, points, scratch.order.data(), scratch.sort);
}

} // namespace tread::mpm
