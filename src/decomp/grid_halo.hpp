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

/// Node pages shared with other ranks, and the sum of all ranks' contributions to them. Point pages that reach shared
/// nodes ("border pages") are scattered first, and their contributions are sent while the others are scattered.
/// Collective.
template<class Exec, class Real>
class GridHalo
{
public:
    explicit GridHalo(Decomposition<Exec>& decomposition);

    /// Finds the shared pages; call after the point pages have changed. Pages that walls tie to shared ones are
    /// included.
    void plan(mpm::Pages<Exec>& pages, const mpm::GridWalls& walls);

    /// The same for loaded pages, which plan() had once extended: a page that is only tied to a rank's own is no page
    /// of its points, and another rank accounts for it.
    void resume(mpm::Pages<Exec>& pages, const mpm::GridWalls& walls);

    /// Runs P2G of the border pages, `scatter(exec, list)`, on a secondary stream, and sends their contributions to
    /// `tiles`.
    template<class Scatter>
    void begin(const mpm::PagesView& pages, const Real* tiles, const Scatter& scatter)
    {
        stream_.fork();
        scatter(stream_.exec(), mpm::PageList{border_.size(), border_.data()});
        send(pages, tiles);
    }

    /// The other point pages, whose P2G depends neither on begin() nor on finish().
    mpm::PageList interior() const { return {interior_.size(), interior_.data()}; }

    /// Adds up the contributions; view() and the tiles of border pages are valid afterwards.
    void finish();

    mpm::SharedPagesView<Real> view() const { return shared_.view(); }

    /// Clears the tallies of node pages (`width` numbers each) that another rank accounts for.
    void clear_tallied_elsewhere(int width, double* tallies);

    std::int64_t pages() const { return shared_.page.size(); }

private:
    void send(const mpm::PagesView& pages, const Real* tiles);
    void list_border(const mpm::Pages<Exec>& pages, const std::vector<std::int32_t>& shared_number);

    Decomposition<Exec>&         decomposition_;
    SecondaryStream<Exec>        stream_;
    mpm::SharedPages<Exec, Real> shared_;
    Array<Exec, std::int32_t>    border_;   ///< point pages
    Array<Exec, std::int32_t>    interior_; ///< all other point pages
    Exchange<Exec>               exchange_;
};

} // namespace tread::decomp
