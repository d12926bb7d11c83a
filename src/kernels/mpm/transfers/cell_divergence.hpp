#pragma once

#include "kernels/mpm/pages/page_list.hpp"
#include "kernels/mpm/points.hpp"

namespace tread::mpm
{

/// Computes the volume-weighted mean (initial volumes) of the velocity divergence at mid-step (dt, s) over the points
/// of every cell of the listed pages, 1/s, into cell_divergence[64 * point page + place in the page]; 0 without points.
/// `motion` as in gather, before the points move. With the law's volumetric strain from these means, the points of a
/// cell impose one constraint on its nodes' velocities instead of one each, so that isochoric flow does not lock
/// (selective reduced integration: Hughes 1980, Int. J. Numer. Methods Eng. 15:1413). P2G must average the pressure in
/// the same way (cell_stress.hpp).
template<class Exec, class Real>
void average_divergence(const Exec&, const PointsView<Real>& points, const PagesView& pages, const PageList& list,
                        const Real* motion, Real dt, Real* cell_divergence);

} // namespace tread::mpm
