#pragma once

#include "kernels/mpm/pages/moves.hpp"
#include "kernels/mpm/pages/pages.hpp"

namespace tread::mpm
{

/// The lists before and after the moves.
struct Relisting
{
    PagesView           old;
    MovesView           moves;
    const std::int32_t* first_point;      ///< new, [point_pages + 1]
    std::int32_t*       cell_first_point; ///< new
    std::int32_t*       point_at;         ///< new
    std::uint8_t*       place_at;         ///< new
};

/// Number of points that arrive in `page` from its neighbour in a direction; they move in the opposite direction.
TREAD_HD std::int32_t arrivals(const PagesView& pages, const MovesView& moves, std::int64_t page, int direction)
{
    const std::int32_t from = pages.neighbour[page * directions + direction];
    if (from < 0 || direction == own_page) { return 0; }
    return moves.count[std::int64_t(from) * move_counts + directions - 1 - direction];
}

/// Number of points in a page after the moves.
TREAD_HD std::int32_t count_after(const PagesView& pages, const MovesView& moves, std::int64_t page)
{
    std::int32_t points = pages.first_point[page + 1] - pages.first_point[page];
    for (int d = 0; d < directions; ++d)
    {
        points += arrivals(pages, moves, page, d) - moves.count[page * move_counts + d];
    }
    return points;
}

struct CountAfter
{
    PagesView     pages;
    MovesView     moves;
    std::int32_t* count; ///< [point_pages + 1], the last is 0

    TREAD_HD void operator()(std::int64_t page) const
    {
        if (!moves.any_changed_cell()) { return; }
        count[page] = page < pages.point_pages ? count_after(pages, moves, page) : 0;
    }
};

/// Whether no point of the page changed its cell and none arrived: the list is then unchanged.
TREAD_HD bool unchanged(const PagesView& pages, const MovesView& moves, std::int64_t page)
{
    std::int32_t changes = moves.count[page * move_counts + changed_points];
    for (int d = 0; d < directions; ++d) { changes += arrivals(pages, moves, page, d); }
    return changes == 0;
}

} // namespace tread::mpm
