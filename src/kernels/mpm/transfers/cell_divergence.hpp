#pragma once

#include "kernels/mpm/pages/page_list.hpp"
#include "kernels/mpm/points.hpp"

namespace tread::mpm
{

/// Mean of the velocity divergence in the middle of the step (dt, s) over the points of every cell of the listed pages,
/// weighted by their initial volumes, 1/s, into cell_divergence[64 * point page + place in the page]; 0 where there are
/// no points. `motion` as gather reads it, before it moves the points. With the law's volumetric strain from these
/// means the points of a cell are one constraint on its nodes' velocities instead of one each, and flow that keeps its
/// volume does not lock (selective reduced integration: Hughes 1980, Int. J. Numer. Methods Eng. 15:1413). P2G must
/// share pressure alike (cell_stress.hpp).
template<class Real>
void average_divergence(const Cpu&, const PointsView<Real>& points, const PagesView& pages, const PageList& list,
                        const Real* motion, Real dt, Real* cell_divergence);
template<class Real>
void average_divergence(const Gpu&, const PointsView<Real>& points, const PagesView& pages, const PageList& list,
                        const Real* motion, Real dt, Real* cell_divergence);

} // namespace tread::mpm
