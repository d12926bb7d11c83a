#include "solver/sand_ranks.hpp"

#include "solver/state_file.hpp"

namespace tread::solver
{

template<class Exec, class Real>
SandRanks<Exec, Real>::SandRanks(decomp::Decomposition<Exec>& decomposition, double threshold)
    : decomposition_(decomposition)
    , migration_(decomposition)
    , halo_(decomposition)
    , rule_(threshold)
{
}

template<class Exec, class Real>
void SandRanks<Exec, Real>::order(mpm::Points<Exec, Real>& points, mpm::Pages<Exec>& pages,
                                  const mpm::GridGeometry& geometry, const mpm::GridWalls& walls,
                                  mpm::OrderScratch<Exec, Real>& scratch, std::int64_t step)
{
    moved_ = migration_.run(points, geometry, scratch);
    balance_.points_moved += moved_;
    mpm::order_points(decomposition_.transport.exec(), points, pages, geometry, scratch);
    halo_.plan(pages, walls);
    dealt_out_ = rebalance(pages, step);
}

template<class Exec, class Real>
bool SandRanks<Exec, Real>::is_due(std::int64_t step) const
{
    const bool known = !balance_.loads.empty();
    return dealt_out_ || (known && step >= not_before_ && rule_.is_due(balance_.loads, step - partitioned_));
}

/// The load of a page is the number of its points. What was not worth it is looked at again when twice as many steps
/// have gone by.
template<class Exec, class Real>
bool SandRanks<Exec, Real>::rebalance(const mpm::Pages<Exec>& pages, std::int64_t step)
{
    const std::vector<std::uint64_t> listed = pages.point_page_key.to_host();
    const std::vector<std::int32_t>  first  = pages.first_point.to_host();
    decomp::PageKeys                 key;
    std::vector<double>              load;
    for (std::size_t page = 0; page < listed.size(); ++page)
    {
        if (first[page] == first[page + 1]) { continue; }
        key.push_back(listed[page]);
        load.push_back(first[page + 1] - first[page]);
    }
    const bool changed = decomp::rebalance(decomposition_, rule_, key, load, step - partitioned_, balance_);
    if (changed) { partitioned_ = step; }
    else if (rule_.is_due(balance_.loads, step - partitioned_)) { not_before_ = 2 * step - partitioned_; }
    return changed;
}

template<class Exec, class Real>
void SandRanks<Exec, Real>::transfer(StateFile& file)
{
    std::vector<std::uint64_t> keys  = decomposition_.owners.keys();
    decomp::PageRanks          ranks = decomposition_.owners.ranks();
    file.common("ranks/page_key", keys);
    file.common("ranks/page_owner", ranks);
    file.common("ranks/loads", balance_.loads);
    file.numbers("ranks/balance", balance_.imbalance, balance_.repartitions, balance_.points_moved, dealt_out_,
                 partitioned_, not_before_);
    if (file.loads()) { decomposition_.owners.assign(keys, ranks); }
}

template class SandRanks<Cpu, float>;
template class SandRanks<Cpu, double>;
#ifdef TREAD_WITH_CUDA
template class SandRanks<Gpu, float>;
template class SandRanks<Gpu, double>;
#endif

} // namespace tread::solver
