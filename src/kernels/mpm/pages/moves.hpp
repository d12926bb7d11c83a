#pragma once

#include <cstdint>

#include "kernels/mpm/pages/pages.hpp"

namespace tread::mpm
{

/// Change of a point's place in the list during a step, in order of severity.
enum class CellChange : std::int32_t
{
    none,      ///< same cell
    moved,     ///< another cell on a listed page
    rim,       ///< a far cell, or one next to a page that is not listed or of another level: reorder the points soon
    lost,      ///< no listed page: the points must be reordered now
    not_finite ///< position, velocity or stress is not finite
};

/// New place of a point after a step, relative to its page.
struct Move
{
    int        direction; ///< to the new page
    int        place;     ///< cell in that page
    CellChange cell_change;
};

/// Entries per page: number of points that leave it in each direction (0 for `own_page`); the last entry counts the
/// points that changed their cell.
constexpr int changed_points = directions;
constexpr int move_counts    = directions + 1;

/// Moves of all points, by their places in the list before the step.
struct MovesView
{
    std::uint16_t* to;         ///< [points], place in the page + 64 * direction
    std::int32_t*  count;      ///< [point pages][move_counts]
    std::int64_t*  changed_in; ///< the last step in which a point changed its cell
    std::int64_t   step;       ///< number of the step

    TREAD_HD bool any_changed_cell() const { return *changed_in == step; }
};

/// Whether any page next to a cell (`place` of `page`) is not listed.
TREAD_HD bool at_rim(const PagesView& pages, std::int64_t page, int place)
{
    const int at[] = {place & 3, place >> 2 & 3, place >> 4};
    int       step[3];
    for (int c = 0; c < 3; ++c) { step[c] = at[c] == 0 ? -1 : at[c] == page_edge - 1 ? 1 : 0; }
    for (int octant = 1; octant < 8; ++octant)
    {
        const int direction =
            own_page + step[0] * (octant & 1) + 3 * step[1] * (octant >> 1 & 1) + 9 * step[2] * (octant >> 2);
        if (pages.neighbour[page * directions + direction] < 0 && direction != own_page) { return true; }
    }
    return false;
}

/// Computes the move of a point of cell `before` that is at `position` now. A point without a listed page to move to
/// stays in its own page until the points are reordered.
TREAD_HD Move move_to(const PagesView& pages, std::int64_t page, Index3 before, const Vec3<double>& position)
{
    if (stays_in(before, position, pages)) { return {own_page, place_in_page(before), CellChange::none}; }
    const Index3 now  = cell_of(position, pages);
    const Index3 from = page_of(before), to = page_of(now);
    const int    x = to.x - from.x, y = to.y - from.y, z = to.z - from.z;
    const Move   stay{own_page, place_in_page(before), CellChange::lost};
    if (x < -1 || x > 1 || y < -1 || y > 1 || z < -1 || z > 1) { return stay; }
    const int          direction = own_page + x + 3 * y + 9 * z;
    const std::int32_t reached   = pages.neighbour[page * directions + direction];
    if (reached < 0) { return stay; }
    const int  place  = place_in_page(now);
    const bool is_far = pages.far_cells != nullptr && (pages.far_cells[reached] >> place & 1) != 0;
    const bool soon =
        is_far || pages.replaced.contains(now) || !pages.own.contains(now) || at_rim(pages, reached, place);
    return {direction, place, soon ? CellChange::rim : CellChange::moved};
}

TREAD_HD std::uint16_t packed(const Move& move)
{
    return static_cast<std::uint16_t>(move.place + page_cells * move.direction);
}

} // namespace tread::mpm
