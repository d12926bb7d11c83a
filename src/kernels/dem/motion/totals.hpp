#pragma once

#include <cstdint>

#include "backend/array.hpp"
#include "backend/vector.hpp"

// Totals of the substeps for the balances of momentum and energy, one row per body. Only the body itself writes to its
// row, so that the sums need neither atomics nor any order other than that of the bodies.
namespace tread::dem
{

/// Totals since the start of the run (or since the last clear). Impulses in N s, world frame; work in J.
struct BodyTotal
{
    Vec3<double> wall_impulse;    ///< from planes
    Vec3<double> damping_impulse; ///< from the local damping
    Vec3<double> holding_impulse; ///< from constraints: locked velocities, a share of the weight, joints, sleep; and
                                  ///< what scaled inertia takes
    double friction;     ///< dissipated by tangential and torsional friction, of the pairs whose first body this is
    double restitution;  ///< dissipated by normal damping, of the same pairs
    double damping;      ///< dissipated by local damping
    double holding_work; ///< done on the body by the constraints of holding_impulse
    double scaling_work; ///< taken from the body by its scaled inertia
    double sand_work;    ///< done on the body by sand
};

/// Number of doubles in a BodyTotal, for sums over rows.
inline constexpr int body_total_width = sizeof(BodyTotal) / sizeof(double);
static_assert(body_total_width == 15);

template<class Exec>
using BodyTotals = Array<Exec, BodyTotal>;

} // namespace tread::dem
