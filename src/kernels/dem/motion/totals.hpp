#pragma once

#include <cstdint>

#include "backend/array.hpp"
#include "backend/vector.hpp"

// What the substeps add up for the balances of momentum and energy, one row a body: a body's row is touched by that
// body alone, so that the sums need no atomics and no order but the bodies'.
namespace tread::dem
{

/// Since the start of the run (or the last clear). Impulses in N s, world frame; work in J.
struct BodyTotal
{
    Vec3<double> wall_impulse;    ///< from planes
    Vec3<double> damping_impulse; ///< from the local damping
    Vec3<double> holding_impulse; ///< from what keeps locked freedoms at their velocity or holds a share of the weight
    double       friction;        ///< lost to tangential and torsional friction, of the pairs whose first body this is
    double       restitution;     ///< lost to normal damping, likewise
    double       damping;         ///< lost to the local damping
    double       holding_work;    ///< done on the body by the same
    double       sand_work;       ///< done on the body by sand
};

/// Doubles in a BodyTotal, for sums over rows.
inline constexpr int body_total_width = sizeof(BodyTotal) / sizeof(double);
static_assert(body_total_width == 14);

template<class Exec>
using BodyTotals = Array<Exec, BodyTotal>;

} // namespace tread::dem
