#pragma once

#include "backend/sort.hpp"
#include "kernels/mpm/grid/grid.hpp"

// Sand that sleeps is held: the nodes that its points reach stand still, so that it neither moves nor changes its
// stress. To the points beside it that is a wall which holds whatever touches it.
namespace tread::mpm
{

/// The node pages that sleeping pages reach ("held pages").
struct HeldPagesView
{
    std::int64_t        count;
    const std::int32_t* page;    ///< [count], node page, ascending
    const std::uint8_t* octants; ///< [count], bit o: the page at - (o & 1, o >> 1 & 1, o >> 2) of it sleeps
    double*             impulse; ///< [count][3], N s, what holds the nodes has given since it was cleared
};

/// Owner of what HeldPagesView shows.
template<class Exec>
struct HeldPages
{
    explicit HeldPages(const Exec& exec)
        : page(exec, "held pages")
        , octants(exec, "sleeping pages of held pages")
        , impulse(exec, "impulses of held pages")
        , marks(exec, "marks of held pages")
    {
    }

    HeldPagesView view() { return {page.size(), page.data(), octants.data(), impulse.data()}; }

    Array<Exec, std::int32_t> page;
    Array<Exec, std::uint8_t> octants;
    Array<Exec, double>       impulse;
    Array<Exec, std::int32_t> marks; ///< scratch
};

/// Lists the held pages of `pages`, with impulses of zero. `asleep`: keys of the pages that sleep, ascending.
template<class Exec>
void list_held_pages(const Exec& exec, const PagesView& pages, const Array<Exec, std::uint64_t>& asleep,
                     HeldPages<Exec>& held, SortScratch<Exec>& scratch);

/// Stops the nodes that sleeping pages reach, after update_grid and update_walls; books that in the tallies as a wall's
/// work and impulse. Pre: a step without damping.
template<class Real>
void hold_still(const Cpu&, const PagesView& pages, const HeldPagesView& held, const Real* tiles,
                const GridStep<Real>& step, Real* motion, double* tallies);
template<class Real>
void hold_still(const Gpu&, const PagesView& pages, const HeldPagesView& held, const Real* tiles,
                const GridStep<Real>& step, Real* motion, double* tallies);

/// largest[page] becomes the larger of itself and the page's peak_speed_squared, m2/s2.
void keep_largest_speeds(const Cpu&, std::int64_t pages, const double* peaks, double* largest);
void keep_largest_speeds(const Gpu&, std::int64_t pages, const double* peaks, double* largest);

} // namespace tread::mpm
