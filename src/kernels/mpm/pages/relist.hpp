#pragma once

#include "backend/sort.hpp"
#include "kernels/mpm/pages/moves.hpp"
#include "kernels/mpm/pages/pages.hpp"

namespace tread::mpm
{

/// Buffers of relist_points, kept between calls; their contents are copied to the arrays of the pages.
template<class Exec>
struct RelistScratch
{
    explicit RelistScratch(const Exec& exec)
        : sort(exec)
        , first_point(exec, "relist first point")
        , cell_first_point(exec, "relist cell first point")
    {
    }

    SortScratch<Exec>         sort;
    Array<Exec, std::int32_t> first_point;
    Array<Exec, std::int32_t> cell_first_point;
};

/// Lists every point in the cell to which it moved; no point moves in memory. Within a cell, points that stayed in the
/// page come first, then those from neighbours by direction, each in the order of the old list.
/// Does nothing if no point changed its cell (tested on the device). Preconditions: `moves` belongs to the present list
/// and no point is lost (CellChange). Postcondition: every point is listed in the range of its cell. `room`: buffer for
/// the new list, any array that others use between the calls.
template<class Exec>
void relist_points(const Exec& exec, Pages<Exec>& pages, const MovesView& moves, RelistScratch<Exec>& scratch,
                   Array<Exec, std::uint64_t>& room);

} // namespace tread::mpm
