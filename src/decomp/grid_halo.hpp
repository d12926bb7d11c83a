#pragma once

#include "decomp/decomposition.hpp"
#include "decomp/exchange.hpp"
#include "decomp/halo_plan.hpp"
#include "kernels/mpm/order.hpp"
#include "kernels/mpm/shared_pages.hpp"
#include "kernels/mpm/walls.hpp"

namespace tread::decomp
{

/// The node pages that this rank shares with others, and what all of them bring to their nodes. Collective.
template<class Exec, class Real>
class GridHalo
{
public:
    explicit GridHalo(Decomposition<Exec>& decomposition);

    /// After the point pages have changed: finds what is shared, and lists what walls hold together with it as well.
    void plan(mpm::Pages<Exec>& pages, const mpm::GridWalls& walls);

    /// After P2G, any time before finish(): sends what the own tiles bring.
    void begin(const mpm::PagesView& pages, const Real* tiles);

    /// Adds up; view() is right from now on.
    void finish();

    mpm::SharedPagesView<Real> view() const { return shared_.view(); }

    /// Of the tallies of node pages, `width` numbers each, clears those that another rank keeps.
    void clear_booked_elsewhere(int width, double* tallies);

    std::int64_t pages() const { return shared_.page.size(); }

private:
    Decomposition<Exec>&         decomposition_;
    mpm::SharedPages<Exec, Real> shared_;
    Exchange<Exec>               exchange_;
};

} // namespace tread::decomp
