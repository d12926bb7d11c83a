#pragma once

#include "kernels/mpm/transfers/cell_stress.hpp"

namespace tread::mpm
{

/// Averages the pressure over the points of cell `cell` = 64 * page + place, in the order of the list.
template<class Real>
TREAD_HD void share_cell_pressure(const PointsView<Real>& points, const PagesView& pages, std::int64_t cell,
                                  const Planes<Real, 6>& shared)
{
    const std::int64_t first = pages.cell_first_point[cell], end = pages.cell_first_point[cell + 1];
    Real               volume = 0, load = 0;
    for (std::int64_t at = first; at < end; ++at)
    {
        const std::int64_t i = pages.point_at[at];
        volume += points.volume[i];
        load += points.volume[i] * points.stress.get(i).template head<3>().sum();
    }
    for (std::int64_t at = first; at < end; ++at)
    {
        const std::int64_t i      = pages.point_at[at];
        Sym3<Real>         stress = points.stress.get(i);
        const Real         change = (load / volume - stress.template head<3>().sum()) * Real(1.0 / 3);
        for (int c = 0; c < 3; ++c) { stress[c] += change; }
        shared.set(i, stress);
    }
}

} // namespace tread::mpm
