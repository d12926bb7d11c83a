#include "solver/ranks/sand_ranks.hpp"

#include "backend/instantiate.hpp"
#include "solver/state_file.hpp"

namespace tread::solver
{

template<class Exec, class Real>
SandRanks<Exec, Real>::SandRanks(decomp::Decomposition<Exec>& decomposition)
    : decomposition_(decomposition)
    , migration_(decomposition)
    , halo_(decomposition)
{
}

template<class Exec, class Real>
std::int64_t SandRanks<Exec, Real>::order(mpm::Points<Exec, Real>& points, mpm::Pages<Exec>& pages,
                                          const mpm::GridGeometry& geometry, const mpm::GridWalls& walls,
                                          mpm::OrderScratch<Exec, Real>& scratch)
{
    moved_                  = migration_.run(points, geometry, scratch);
    const std::int64_t left = mpm::order_points(decomposition_.transport.exec(), points, pages, geometry, scratch);
    halo_.plan(pages, walls);
    return left;
}

template<class Exec, class Real>
void SandRanks<Exec, Real>::transfer(StateFile& file)
{
    std::vector<std::uint64_t> keys  = decomposition_.owners.keys();
    decomp::PageRanks          ranks = decomposition_.owners.ranks();
    const auto                 count = static_cast<std::size_t>(file.communicator().size());
    file.common("ranks/page_key", keys, accept::all(accept::ascending(), accept::distinct()));
    file.common("ranks/page_owner", ranks, accept::all(accept::rows(keys.size()), accept::index(count)));
    if (file.loads()) { decomposition_.owners.assign(keys, ranks); }
}

#define TREAD_INSTANTIATE(Exec, Real) template class SandRanks<Exec, Real>
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
