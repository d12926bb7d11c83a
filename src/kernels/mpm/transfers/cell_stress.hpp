#pragma once

#include "kernels/mpm/pages/pages.hpp"
#include "kernels/mpm/points.hpp"

namespace tread::mpm
{

/// Every point's stress with the mean stress of its cell, Pa, into `shared`: the mean over the points of the
/// cell, weighted by their initial volumes. P2G must take it where the laws see the cells' mean divergence
/// (cell_divergence.hpp): of the two, each is the other's adjoint, so that the nodes' forces do the work that the
/// points' stresses do on their strains. With every point's own pressure in the forces, sand that dilates gained energy
/// out of nothing.
template<class Real>
void share_pressure(const Cpu&, const PointsView<Real>& points, const PagesView& pages, const Planes<Real, 6>& shared);
template<class Real>
void share_pressure(const Gpu&, const PointsView<Real>& points, const PagesView& pages, const Planes<Real, 6>& shared);

} // namespace tread::mpm
