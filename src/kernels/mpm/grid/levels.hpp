#pragma once

#include "kernels/mpm/pages/pages.hpp"

// A refined grid: level 0 has the scene's spacing; each further level halves the spacing in a box that lies within the
// box of the previous level. The knots of quadratic splines of level l are at m h_l + c_l h_l; those of level l + 1 are
// at the same positions and halfway between, so that every spline of a level is a sum of splines of the next,
//   N_i = (n_2i-2 + 3 n_2i-1 + 3 n_2i + n_2i+1) / 4 along each axis,
// This determines the node positions of a level: (j + c_l - 1/2) h_l with c_0 = 1/2, c_l+1 = 2 c_l. Cell m of a level
// covers the cells 2m and 2m + 1 of the next.
//
// All levels share one table of pages. Page coordinates of level l are shifted by level_offset(l) along every axis, so
// that keys ascend by level and neighbour searches are independent of levels.
namespace tread::mpm
{

/// Maximum number of levels beyond the scene's own grid.
constexpr int most_levels = 3;

/// Page coordinates of level l >= 1 start at l << level_bits.
constexpr int          level_bits  = 16;
constexpr std::int32_t level_guard = 8; ///< pages on the negative side of the origin

TREAD_HD int level_of(Index3 page) { return page.x < (1 << level_bits) ? 0 : page.x >> level_bits; }

/// Offset of a level's page coordinates along every axis, in pages.
TREAD_HD std::int32_t level_offset(int level) { return level == 0 ? 0 : (level << level_bits) + level_guard; }

TREAD_HD Index3 shifted_by(Index3 at, std::int32_t shift) { return {at.x + shift, at.y + shift, at.z + shift}; }

/// Returns the lattice of a level: cell = floor(x / spacing - node_shift - stencil_shift), node j at (j + node_shift)
/// spacing.
TREAD_HD Lattice level_lattice(const Lattice& scene, int level)
{
    if (level == 0) { return scene; }
    const double parts = 1 << level;
    return {scene.spacing / parts, scene.inverse_spacing * parts, scene.stencil_shift,
            0.5 * parts - 0.5 - double(level_offset(level)) * page_edge};
}

/// Refined boxes of the grid.
struct Refinement
{
    int     levels = 0;         ///< levels beyond the scene's own grid
    CellBox box[most_levels]{}; ///< of level l at l - 1, in its cells: even, within the box of the level below
};

/// Returns the cells of `level` that the next level replaces: half the next level's box.
TREAD_HD CellBox replaced_cells(const Refinement& refinement, int level)
{
    if (level >= refinement.levels) { return {}; }
    const std::int32_t finer = level_offset(level + 1) * page_edge, own = level_offset(level) * page_edge;
    const CellBox&     box    = refinement.box[level];
    const auto         coarse = [=](std::int32_t at) { return ((at - finer) >> 1) + own; };
    return {{coarse(box.low.x), coarse(box.low.y), coarse(box.low.z)},
            {coarse(box.high.x), coarse(box.high.y), coarse(box.high.z)}};
}

/// Returns a page without the offset of its level.
TREAD_HD Index3 plain_page(Index3 page) { return shifted_by(page, -level_offset(level_of(page))); }

TREAD_HD Index3 plain_node(Index3 page, int place)
{
    return shifted_by(node_at(page, place), -level_offset(level_of(page)) * page_edge);
}

/// Whether the splines of all nodes of level l from `low` to `high`, both included, lie within the box of their level.
TREAD_HD bool all_free(const Refinement& refinement, int level, Index3 low, Index3 high)
{
    const CellBox& box = refinement.box[level - 1];
    return low.x >= box.low.x + 2 && low.y >= box.low.y + 2 && low.z >= box.low.z + 2 && high.x < box.high.x &&
           high.y < box.high.y && high.z < box.high.z;
}

TREAD_HD bool is_slave(const Refinement& refinement, int level, Index3 node)
{
    return level > 0 && !all_free(refinement, level, node, node);
}

TREAD_HD bool has_slaves(const Refinement& refinement, Index3 page)
{
    const int level = level_of(page);
    return level > 0 && !all_free(refinement, level, node_at(page, 0), node_at(page, page_cells - 1));
}

/// Whether a page of level l >= 1 is within two pages of its level's box.
TREAD_HD bool is_near_box(const Refinement& refinement, Index3 page)
{
    constexpr std::int32_t around = 2 * page_edge;
    const CellBox&         box    = refinement.box[level_of(page) - 1];
    const Index3           low = node_at(page, 0), high = node_at(page, page_cells - 1);
    return high.x >= box.low.x - around && high.y >= box.low.y - around && high.z >= box.low.z - around &&
           low.x < box.high.x + around && low.y < box.high.y + around && low.z < box.high.z + around;
}

/// Returns the page of the next level in a direction from twice a page.
TREAD_HD Index3 finer_page(Index3 page, int direction)
{
    const Index3 plain = plain_page(page);
    return shifted_by(page_towards({2 * plain.x, 2 * plain.y, 2 * plain.z}, direction),
                      level_offset(level_of(page) + 1));
}

/// Returns the page of the level below that contains the lowest parents of a page's nodes, + octant.
TREAD_HD Index3 coarser_page(Index3 page, int octant)
{
    const Index3 plain = plain_page(page);
    return shifted_by(page_at_octant({plain.x >> 1, plain.y >> 1, plain.z >> 1}, octant),
                      level_offset(level_of(page) - 1));
}

/// Returns the cell of a position on the finest level there.
TREAD_HD Index3 finest_cell(const Lattice& scene, const Refinement& refinement, const Vec3<double>& position)
{
    Index3 cell = cell_of(position, scene);
    for (int level = 1; level <= refinement.levels; ++level)
    {
        const Index3 finer = cell_of(position, level_lattice(scene, level));
        if (!refinement.box[level - 1].contains(finer)) { return cell; }
        cell = finer;
    }
    return cell;
}

/// Returns the view with the lattice of a level; the tables remain those of all levels.
inline PagesView on_level(const PagesView& pages, const Refinement& refinement, int level)
{
    PagesView view              = pages;
    static_cast<Lattice&>(view) = level_lattice(pages, level);
    view.replaced               = replaced_cells(refinement, level);
    if (level > 0) { view.own = refinement.box[level - 1].grown(1); }
    return view;
}

} // namespace tread::mpm
