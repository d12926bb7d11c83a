#include "solver/ranks/sand_ranks.hpp"

#include "backend/instantiate.hpp"

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

#define TREAD_INSTANTIATE(Exec, Real) template class SandRanks<Exec, Real>
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
