#pragma once

#include <algorithm>
#include <vector>

#include "backend/instantiate.hpp"
#include "kernels/mpm/grid/seams_kern.hpp"
#include "kernels/mpm/pages/numbered_pages_impl.hpp"
#include "kernels/mpm/pages/shared_pages_impl.hpp"

// Steps of seams.hpp, for both backends; seams.cpp and seams.cu provide for_each and instantiate.
namespace tread::mpm
{
namespace seam_steps
{

struct IsSeamPage
{
    PagesView  pages;
    Refinement refinement;

    TREAD_HD bool operator()(std::int64_t i) const
    {
        const Index3 page = page_coordinates(pages.node_page_key[i]);
        if (has_slaves(refinement, page)) { return true; }
        if (level_of(page) == refinement.levels) { return false; }
        for (int d = 0; d < directions; ++d)
        {
            const Index3 finer = finer_page(page, d);
            if (is_near_box(refinement, finer) && has_slaves(refinement, finer) && find_node_page(pages, finer) >= 0)
            {
                return true;
            }
        }
        return false;
    }
};

struct FindChild
{
    PagesView           pages;
    Refinement          refinement;
    const std::int32_t* page;
    const std::int32_t* number_of;
    std::int32_t*       child;

    TREAD_HD void operator()(std::int64_t i) const
    {
        const Index3 own = page_coordinates(pages.node_page_key[page[i / directions]]);
        child[i]         = -1;
        if (level_of(own) == refinement.levels) { return; }
        const std::int32_t found = find_node_page(pages, finer_page(own, static_cast<int>(i % directions)));
        if (found >= 0) { child[i] = number_of[found]; }
    }
};

struct FindParent
{
    PagesView           pages;
    const std::int32_t* page;
    std::int32_t*       parent;

    TREAD_HD void operator()(std::int64_t i) const
    {
        const Index3 own = page_coordinates(pages.node_page_key[page[i / octants]]);
        parent[i] = level_of(own) == 0 ? -1 : find_node_page(pages, coarser_page(own, static_cast<int>(i % octants)));
    }
};

/// Finds the first point page of a level.
struct FindLevel
{
    PagesView     pages;
    std::int64_t* start;

    TREAD_HD void operator()(std::int64_t level) const
    {
        const std::int32_t  low = static_cast<std::int32_t>(level) << level_bits;
        const std::uint64_t key = page_key({low, low, low});
        start[level]            = level == 0 ? 0 : lower_bound(pages.point_page_key, pages.point_pages, key);
    }
};

template<class Real>
struct HandDown
{
    PagesView           pages;
    Refinement          refinement;
    int                 level; ///< receiving level
    const std::int32_t* page;
    const std::int32_t* child;
    Real*               total;

    TREAD_HD void operator()(std::int64_t i) const
    {
        const std::int64_t number = i / page_cells;
        const int          place  = static_cast<int>(i % page_cells);
        const Index3       own    = page_coordinates(pages.node_page_key[page[number]]);
        if (level_of(own) != level) { return; }
        add_children(refinement, own, place, child + number * directions, total,
                     total + number * node_page_values + place);
    }
};

template<class Real>
struct EmptySlaves
{
    PagesView           pages;
    Refinement          refinement;
    const std::int32_t* page;
    Real*               total;

    TREAD_HD void operator()(std::int64_t i) const
    {
        const std::int64_t number = i / page_cells;
        const int          place  = static_cast<int>(i % page_cells);
        const Index3       own    = page_coordinates(pages.node_page_key[page[number]]);
        if (!is_slave(refinement, level_of(own), node_at(own, place))) { return; }
        for (int c = 0; c < node_channels; ++c) { total[number * node_page_values + c * page_cells + place] = 0; }
    }
};

template<class Real>
struct FollowParents
{
    PagesView           pages;
    Refinement          refinement;
    int                 level; ///< level of the slave nodes
    const std::int32_t* page;
    const std::int32_t* parent;
    Real*               motion;

    TREAD_HD void operator()(std::int64_t i) const
    {
        const std::int64_t number = i / page_cells;
        const int          place  = static_cast<int>(i % page_cells);
        const Index3       own    = page_coordinates(pages.node_page_key[page[number]]);
        if (level_of(own) != level || !is_slave(refinement, level, node_at(own, place))) { return; }
        write_motion(follow_parents(own, place, parent + number * octants, motion),
                     motion + std::int64_t(page[number]) * motion_channels * page_cells + place);
    }
};

} // namespace seam_steps

template<class Exec, class Real>
void list_seams(const Exec& exec, const PagesView& pages, const Refinement& refinement, Seams<Exec, Real>& seams,
                SortScratch<Exec>& scratch)
{
    using namespace seam_steps;
    number_pages(exec, pages, IsSeamPage{pages, refinement}, "mark seam pages", "write seam pages", seams.page,
                 seams.number_of, scratch);
    const std::int64_t count = seams.page.size();
    seams.child.resize(directions * count);
    for_each(exec, "find finer pages", seams.child.size(),
             FindChild{pages, refinement, seams.page.data(), seams.number_of.data(), seams.child.data()});
    seams.parent.resize(octants * count);
    for_each(exec, "find coarser pages", seams.parent.size(),
             FindParent{pages, seams.page.data(), seams.parent.data()});
    seams.total.resize(count * node_page_values);
    for_each(exec, "find levels", refinement.levels + 1, FindLevel{pages, seams.level_start.data()});
    const std::vector<std::int64_t> start = seams.level_start.to_host();
    seams.first_page.fill(pages.point_pages);
    std::copy_n(start.begin(), refinement.levels + 1, seams.first_page.begin());
}

template<class Exec, class Real>
void hand_down(const Exec& exec, const PagesView& pages, const Refinement& refinement, const Real* tiles,
               Seams<Exec, Real>& seams)
{
    using namespace seam_steps;
    const std::int64_t nodes = seams.page.size() * page_cells;
    for_each(exec, "totals of seam pages", nodes,
             SumOwnPart<Real>{pages, seams.page.data(), tiles, seams.total.data()});
    for (int level = refinement.levels - 1; level >= 0; --level)
    {
        for_each(exec, "hand down", nodes,
                 HandDown<Real>{pages, refinement, level, seams.page.data(), seams.child.data(), seams.total.data()});
    }
    for_each(exec, "empty slave nodes", nodes,
             EmptySlaves<Real>{pages, refinement, seams.page.data(), seams.total.data()});
}

template<class Exec, class Real>
void follow_coarser(const Exec& exec, const PagesView& pages, const Refinement& refinement,
                    const Seams<Exec, Real>& seams, Real* motion)
{
    using namespace seam_steps;
    for (int level = 1; level <= refinement.levels; ++level)
    {
        for_each(exec, "follow coarser nodes", seams.page.size() * page_cells,
                 FollowParents<Real>{pages, refinement, level, seams.page.data(), seams.parent.data(), motion});
    }
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void list_seams(const Exec&, const PagesView&, const Refinement&, Seams<Exec, Real>&,                     \
                             SortScratch<Exec>&);                                                                      \
    template void hand_down(const Exec&, const PagesView&, const Refinement&, const Real*, Seams<Exec, Real>&);        \
    template void follow_coarser(const Exec&, const PagesView&, const Refinement&, const Seams<Exec, Real>&, Real*)
TREAD_FOR_THIS_BACKEND_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::mpm
