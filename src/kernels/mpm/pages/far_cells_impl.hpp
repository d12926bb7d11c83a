#pragma once

#include "kernels/mpm/pages/far_cells.hpp"

// Far cells of pages, for both backends; far_cells.cpp and far_cells.cu provide for_each and instantiate.
namespace tread::mpm
{

/// Writes the far cells of a point page.
struct MarkFarCells
{
    const std::uint64_t* key;
    PageOwnersView       owners;
    std::int32_t         self;
    std::uint64_t*       far_cells;

    TREAD_HD void operator()(std::int64_t page) const
    {
        constexpr std::uint64_t all = ~std::uint64_t{0};
        far_cells[page]             = owners.of(key[page]) == self ? 0 : all & ~beside_own(page_coordinates(key[page]));
    }

private:
    /// Cells that share a face with a page of this rank, by place in the page.
    TREAD_HD std::uint64_t beside_own(Index3 page) const
    {
        std::uint64_t cells = 0;
        for (int axis = 0; axis < 3; ++axis)
        {
            for (int side = -1; side <= 1; side += 2)
            {
                const int direction = own_page + side * (axis == 0 ? 1 : axis == 1 ? 3 : 9);
                if (owners.of(page_key(page_towards(page, direction))) == self) { cells |= layer(axis, side); }
            }
        }
        return cells;
    }

    /// Outermost cells of a page on one side (-1 or 1) of an axis.
    TREAD_HD static std::uint64_t layer(int axis, int side)
    {
        const int     at    = side < 0 ? 0 : page_edge - 1;
        std::uint64_t cells = 0;
        for (int place = 0; place < page_cells; ++place)
        {
            const int coordinate = place >> (2 * axis) & 3;
            if (coordinate == at) { cells |= std::uint64_t{1} << place; }
        }
        return cells;
    }
};

template<class Exec>
void mark_far_cells(const Exec& exec, Pages<Exec>& pages, const PageOwnersView& owners, std::int32_t self)
{
    const std::int64_t count = pages.point_page_key.size();
    pages.far_cells.resize(count);
    for_each(exec, "far cells of pages", count,
             MarkFarCells{pages.point_page_key.data(), owners, self, pages.far_cells.data()});
}

} // namespace tread::mpm
