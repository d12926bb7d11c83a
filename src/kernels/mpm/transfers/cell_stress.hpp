#pragma once

#include "kernels/mpm/pages/pages.hpp"
#include "kernels/mpm/points.hpp"

namespace tread::mpm
{

/// Replaces the mean stress of every point by the volume-weighted mean (initial volumes) over the points of its cell,
/// Pa, and writes the stress to `shared`. P2G must use it if the laws use the cells' mean divergence
/// (cell_divergence.hpp): the two operators are adjoint, so that the nodal forces do the same work as the points'
/// stresses on their strains. With each point's own pressure in the forces, dilating sand gained energy.
template<class Exec, class Real>
void share_pressure(const Exec&, const PointsView<Real>& points, const PagesView& pages, const Planes<Real, 6>& shared);

} // namespace tread::mpm
