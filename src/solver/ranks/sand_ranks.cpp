#include "solver/ranks/sand_ranks.hpp"

#include "backend/instantiate.hpp"
#include "kernels/mpm/pages/far_cells.hpp"

namespace tread::solver
{

template<class Exec, class Real>
SandRanks<Exec, Real>::SandRanks(decomp::Decomposition<Exec>& decomposition, Outside outside)
    : decomposition_(decomposition)
    , outside_(outside)
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
    mark_far_cells(pages);
    halo_.plan(pages, walls);
    return left;
}

template<class Exec, class Real>
void SandRanks<Exec, Real>::resume(mpm::Pages<Exec>& pages, const mpm::GridWalls& walls)
{
    mark_far_cells(pages);
    halo_.resume(pages, walls);
}

template<class Exec, class Real>
void SandRanks<Exec, Real>::mark_far_cells(mpm::Pages<Exec>& pages)
{
    if (outside_ == Outside::anywhere) { return; }
    mpm::mark_far_cells(decomposition_.transport.exec(), pages, decomposition_.owners.view(), decomposition_.rank());
}

#define TREAD_INSTANTIATE(Exec, Real) template class SandRanks<Exec, Real>
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
