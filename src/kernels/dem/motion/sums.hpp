#pragma once

#include "kernels/dem/motion/totals.hpp"
#include "kernels/dem/pairs/pairs.hpp"

namespace tread::dem
{

/// Sums over all bodies. Energies in J.
struct BodySums
{
    double       kinetic;   ///< translation and rotation
    double       potential; ///< -m g . x
    Vec3<double> momentum;  ///< N s
    Vec3<double> spin;      ///< N m s, angular momentum about the world's origin
    double       contact;   ///< elastic energy of normal tractions and of the patches' springs, of the last substep
    BodyTotal    total;     ///< since the totals were cleared
};

/// Computes the sums in a fixed order; waits for the backend. gravity in m/s2.
template<class Exec>
BodySums sum_bodies(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyTotals<Exec>& totals,
                    const Vec3<double>& gravity);

} // namespace tread::dem
