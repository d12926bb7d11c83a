#pragma once

#include "kernels/mpm/laws/material_parameters.hpp"
#include "kernels/mpm/pages/pages.hpp"
#include "kernels/mpm/points.hpp"

namespace tread::mpm
{

/// Sums over the points for the ledger, fp64.
enum PointCensus : int
{
    census_mass,                         ///< kg
    census_kinetic,                      ///< J, 1/2 m v^2
    census_strain,                       ///< J, elastic, V (p^2/(2K) + s:s/(4G))
    census_momentum,                     ///< kg m/s (3)
    census_moment = census_momentum + 3, ///< kg m, mass times position (3)
    census_count  = census_moment + 3
};

/// Computes rows[point page][PointCensus]: sums over the page's points in their order.
template<class Exec, class Real>
void take_census(const Exec&, const PointsView<Real>& points, const PagesView& pages,
                 const MaterialParameters<Real>* materials, double* rows);

} // namespace tread::mpm
