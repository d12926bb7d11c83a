#pragma once

#include "kernels/mpm/laws/law_kern.hpp"
#include "kernels/mpm/pages/census.hpp"

namespace tread::mpm
{

/// Adds one point to a row of the census.
template<class Real>
TREAD_HD void count_point(const PointsView<Real>& points, std::int64_t i, const MaterialParameters<Real>* materials,
                          double* row)
{
    const double       mass     = points.mass[i];
    const Vec3<double> velocity = points.velocity.get(i).template cast<double>();
    const Vec3<double> position = points.position.get(i);
    const double       volume   = double(points.volume[i]);
    row[census_mass] += mass;
    row[census_kinetic] += 0.5 * mass * velocity.squaredNorm();
    row[census_strain] += volume * double(elastic_energy_density(materials[points.material[i]], points.stress.get(i)));
    for (int c = 0; c < 3; ++c)
    {
        row[census_momentum + c] += mass * velocity[c];
        row[census_moment + c] += mass * position[c];
    }
}

} // namespace tread::mpm
