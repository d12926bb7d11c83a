#pragma once

#include <cstdint>

#include "backend/array.hpp"
#include "kernels/mpm/grid/lattice.hpp"

namespace tread::mpm
{

/// Number of directions from a page to its neighbours: (d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1); `own_page` is the page
/// itself.
constexpr int directions = 27;
constexpr int own_page   = 13;

TREAD_HD Index3 page_towards(Index3 page, int direction)
{
    return {page.x + direction % 3 - 1, page.y + direction / 3 % 3 - 1, page.z + direction / 9 - 1};
}

/// Returns the page at an octant, (octant & 1, octant >> 1 & 1, octant >> 2), of a page; `sign` -1: at the opposite
/// one.
TREAD_HD Index3 page_at_octant(Index3 page, int octant, int sign = 1)
{
    return {page.x + sign * (octant & 1), page.y + sign * (octant >> 1 & 1), page.z + sign * (octant >> 2)};
}

/// Tables of the pages: those that hold points with all their neighbours ("point pages"), and those in their stencils
/// ("node pages", a superset). Points are listed by page key, then by place in the page; their memory order is that of
/// the last reordering. The cell of a point is the one in which it is listed.
struct PagesView : Lattice
{
    int          levels;   ///< number of levels beyond the scene's own grid (levels.hpp); tables contain all levels
    CellBox      replaced; ///< cells in which points belong to the next level
    CellBox      own;      ///< cells in which points may stay on this level
    std::int64_t point_pages;
    std::int64_t node_pages;
    const std::uint64_t* point_page_key;   ///< [point_pages], ascending
    const std::int32_t*  first_point;      ///< [point_pages + 1], into the list
    const std::int32_t*  cell_first_point; ///< [64 * point_pages + 1], into the list, by place in the page
    const std::int32_t*  point_at;         ///< [points], the list: index in memory of each point
    const std::uint8_t*  place_at;         ///< [points], by place in the list: place in its page of the point's cell
    const std::int32_t*  neighbour;        ///< [27 * point_pages], point page by direction, or -1
    const std::uint64_t* node_page_key;    ///< [node_pages], ascending
    const std::int32_t*  node_page_of;     ///< [8 * point_pages], node page at + (o & 1, o >> 1 & 1, o >> 2)
    const std::int32_t*  point_page_of;    ///< [8 * node_pages], point page at - (o & 1, o >> 1 & 1, o >> 2), or -1
    const std::uint64_t* far_cells;        ///< [point_pages], a bit for each cell; null: none is far (far_cells.hpp)
};

/// Memory of PagesView.
template<class Exec>
struct Pages
{
    explicit Pages(const Exec& exec)
        : point_page_key(exec, "point page keys")
        , first_point(exec, "point page first point")
        , cell_first_point(exec, "cell first point")
        , point_at(exec, "point list")
        , place_at(exec, "point list cells")
        , neighbour(exec, "neighbours of point pages")
        , node_page_key(exec, "node page keys")
        , node_page_of(exec, "node pages of point pages")
        , point_page_of(exec, "point pages of node pages")
        , far_cells(exec, "far cells of point pages")
    {
    }

    /// Makes the view; `levels`: beyond the scene's own grid, whose lattice is given.
    PagesView view(const Lattice& lattice, int levels = 0) const
    {
        return {lattice,
                levels,
                CellBox{},
                all_cells(),
                point_page_key.size(),
                node_page_key.size(),
                point_page_key.data(),
                first_point.data(),
                cell_first_point.data(),
                point_at.data(),
                place_at.data(),
                neighbour.data(),
                node_page_key.data(),
                node_page_of.data(),
                point_page_of.data(),
                far_cells.size() > 0 ? far_cells.data() : nullptr};
    }

    PagesView view(double spacing, double stencil_shift) const { return view(make_lattice(spacing, stencil_shift)); }

    /// Calls f(name, array) for every array but the far cells, which follow from keys and owners.
    template<class F>
    void for_each_field(F f)
    {
        f("point_page_key", point_page_key);
        f("first_point", first_point);
        f("cell_first_point", cell_first_point);
        f("point_at", point_at);
        f("place_at", place_at);
        f("neighbour", neighbour);
        f("node_page_key", node_page_key);
        f("node_page_of", node_page_of);
        f("point_page_of", point_page_of);
    }

    Array<Exec, std::uint64_t> point_page_key;
    Array<Exec, std::int32_t>  first_point;
    Array<Exec, std::int32_t>  cell_first_point;
    Array<Exec, std::int32_t>  point_at;
    Array<Exec, std::uint8_t>  place_at;
    Array<Exec, std::int32_t>  neighbour;
    Array<Exec, std::uint64_t> node_page_key;
    Array<Exec, std::int32_t>  node_page_of;
    Array<Exec, std::int32_t>  point_page_of;
    Array<Exec, std::uint64_t> far_cells;
};

} // namespace tread::mpm
