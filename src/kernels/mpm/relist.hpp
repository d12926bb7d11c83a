#pragma once

#include "backend/sort.hpp"
#include "kernels/mpm/moves.hpp"
#include "kernels/mpm/pages.hpp"

namespace tread::mpm
{

/// What relist_points writes before the pages take it over; kept between calls.
template<class Exec>
struct RelistScratch
{
    explicit RelistScratch(const Exec& exec)
        : sort(exec)
        , first_point(exec, "relist first point")
        , cell_first_point(exec, "relist cell first point")
        , point_at(exec, "relist point list")
        , place_at(exec, "relist point list cells")
    {
    }

    SortScratch<Exec>         sort;
    Array<Exec, std::int32_t> first_point;
    Array<Exec, std::int32_t> cell_first_point;
    Array<Exec, std::int32_t> point_at;
    Array<Exec, std::uint8_t> place_at;
};

/// Lists every point in the cell that it moved to; no point moves in memory. In a cell those that stayed in the page
/// come first, then those from neighbours by direction, each in the order of the old list.
/// Does nothing where no point changed its cell; the host does not ask. Pre: `moves` is of the present list and no
/// point is lost (Stir). Post: every point is listed in the range of its cell.
template<class Exec>
void relist_points(const Exec& exec, Pages<Exec>& pages, const MovesView& moves, RelistScratch<Exec>& scratch);

} // namespace tread::mpm
