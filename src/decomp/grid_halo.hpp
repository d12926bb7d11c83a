#pragma once

#include "backend/secondary_stream.hpp"
#include "decomp/decomposition.hpp"
#include "decomp/exchange.hpp"
#include "decomp/halo_plan.hpp"
#include "kernels/mpm/grid/walls.hpp"
#include "kernels/mpm/pages/order.hpp"
#include "kernels/mpm/pages/page_list.hpp"
#include "kernels/mpm/pages/shared_pages.hpp"

namespace tread::decomp
{

/// The node pages that this rank shares with others, and what all of them bring to their nodes. Point pages that reach
/// such nodes ("border pages") are scattered first, and what they bring travels while the others are. Collective.
template<class Exec, class Real>
class GridHalo
{
public:
    explicit GridHalo(Decomposition<Exec>& decomposition);

    /// After the point pages have changed: finds what is shared, and lists what walls hold together with it as well.
    void plan(mpm::Pages<Exec>& pages, const mpm::GridWalls& walls);

    /// Runs P2G of the border pages, `scatter(exec, list)`, on a stream of its own, and sends what they bring to
    /// `tiles`.
    template<class Scatter>
    void begin(const mpm::PagesView& pages, const Real* tiles, const Scatter& scatter)
    {
        stream_.fork();
        scatter(stream_.exec(), mpm::PageList{border_.size(), border_.data()});
        send(pages, tiles);
    }

    /// The other pages, whose P2G needs no begin() nor finish() to be over.
    mpm::PageList interior() const { return {interior_.size(), interior_.data()}; }

    /// Adds up; view() and the border pages' tiles are right from now on.
    void finish();

    mpm::SharedPagesView<Real> view() const { return shared_.view(); }

    /// Of the tallies of node pages, `width` numbers each, clears those that another rank keeps.
    void clear_booked_elsewhere(int width, double* tallies);

    std::int64_t pages() const { return shared_.page.size(); }

private:
    void send(const mpm::PagesView& pages, const Real* tiles);
    void list_border(const mpm::Pages<Exec>& pages, const std::vector<std::int32_t>& shared_number);

    Decomposition<Exec>&         decomposition_;
    SecondaryStream<Exec>        stream_;
    mpm::SharedPages<Exec, Real> shared_;
    Array<Exec, std::int32_t>    border_;   ///< point pages
    Array<Exec, std::int32_t>    interior_; ///< the others
    Exchange<Exec>               exchange_;
};

} // namespace tread::decomp
