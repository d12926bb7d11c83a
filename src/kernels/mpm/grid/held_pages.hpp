#pragma once

#include "backend/sort.hpp"
#include "kernels/mpm/grid/grid.hpp"

// Sleeping sand is held: the nodes of its stencils are fixed, so that neither its positions nor its stresses change.
// For adjacent points this acts like a no-slip wall.
namespace tread::mpm
{

/// Node pages in the stencils of sleeping pages ("held pages").
struct HeldPagesView
{
    std::int64_t        count;
    const std::int32_t* page;    ///< [count], node page, ascending
    const std::uint8_t* octants; ///< [count], bit o: the page at - (o & 1, o >> 1 & 1, o >> 2) of it sleeps
    double*             impulse; ///< [count][3], N s, impulse of the constraint on the nodes since it was cleared
};

/// Memory of HeldPagesView.
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

/// Lists the held pages of `pages` and clears their impulses. `asleep`: keys of the sleeping pages, ascending.
template<class Exec>
void list_held_pages(const Exec& exec, const PagesView& pages, const Array<Exec, std::uint64_t>& asleep,
                     HeldPages<Exec>& held, SortScratch<Exec>& scratch);

/// Stops the nodes in the stencils of sleeping pages, after update_grid and update_walls, and adds this to the tallies
/// like a wall's work and impulse. Takes the totals of shared pages. Precondition: a step without damping.
template<class Exec, class Real>
void hold_still(const Exec&, const PagesView& pages, const HeldPagesView& held,
                const SharedPagesView<Real>& shared_pages, const Real* tiles, const GridStep<Real>& step, Real* motion,
                double* tallies);

/// Sets largest[page] to the maximum of itself and the page's peak_speed_squared, m2/s2.
template<class Exec>
void keep_largest_speeds(const Exec& exec, std::int64_t pages, const double* peaks, double* largest);

} // namespace tread::mpm
