#pragma once

#include <array>

#include "backend/array.hpp"
#include "backend/sort.hpp"
#include "kernels/mpm/grid/levels.hpp"
#include "kernels/mpm/pages/page_list.hpp"
#include "kernels/mpm/pages/shared_pages.hpp"

// Seams between two levels of a refined grid. Nodes of level l whose splines extend beyond the level's box are no
// degrees of freedom ("slave nodes"): they take the motion of the level below through the refinement relation of
// splines (levels.hpp), and pass their mass, momentum and forces to it with the same weights. The other nodes of the
// box are free, and the coarse splines that lie within the box are not needed there. These are truncated hierarchical
// B-splines (Giannelli, Juettler, Speleers 2012, Comput. Aided Geom. Des. 29:485): they sum to one, are non-negative,
// so that lumped masses are positive, and reproduce linear fields exactly; mass, momentum and the work of all forces
// agree on both sides. Points are unaffected: each has 27 nodes of its own level.
namespace tread::mpm
{

/// Node pages with slave nodes, or with nodes on which these depend ("seam pages"). A page number of -1 means none.
template<class Exec, class Real>
struct Seams
{
    explicit Seams(const Exec& exec)
        : page(exec, "seam pages")
        , number_of(exec, "seam pages of node pages")
        , child(exec, "finer pages of seam pages")
        , parent(exec, "coarser pages of seam pages")
        , total(exec, "totals of seam pages")
        , level_start(exec, "first pages of levels", most_levels + 2)
    {
    }

    /// Returns the totals for update_grid; those of slave nodes are zero.
    SharedPagesView<Real> view() const { return {number_of.data(), total.data()}; }

    PageList point_pages(int level) const
    {
        const auto at = static_cast<std::size_t>(level);
        return {first_page[at + 1] - first_page[at], nullptr, first_page[at]};
    }

    Array<Exec, std::int32_t> page;      ///< [seam pages], node page, ascending
    Array<Exec, std::int32_t> number_of; ///< [node pages], its seam page
    Array<Exec, std::int32_t> child;     ///< [seam pages][27], seam page of the next level, by direction from 2 page
    Array<Exec, std::int32_t> parent;    ///< [seam pages][8], node page of the level below, at page/2 + octant
    Array<Exec, Real>         total;     ///< [seam pages][node_channels][page_cells]

    std::array<std::int64_t, most_levels + 2> first_page{}; ///< first point page of level l at [l]
    Array<Exec, std::int64_t>                 level_start;  ///< device copy of first_page
};

/// Lists the seam pages and the levels of `pages`.
template<class Exec, class Real>
void list_seams(const Exec& exec, const PagesView& pages, const Refinement& refinement, Seams<Exec, Real>& seams,
                SortScratch<Exec>& scratch);

/// After P2G: computes the totals of the seam pages, including the parts passed on by slave nodes.
template<class Exec, class Real>
void hand_down(const Exec& exec, const PagesView& pages, const Refinement& refinement, const Real* tiles,
               Seams<Exec, Real>& seams);

/// After update_grid and update_walls: computes the motion of the slave nodes.
template<class Exec, class Real>
void follow_coarser(const Exec& exec, const PagesView& pages, const Refinement& refinement,
                    const Seams<Exec, Real>& seams, Real* motion);

} // namespace tread::mpm
