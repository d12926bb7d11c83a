#pragma once

#include <cmath>
#include <cstdint>

#include "backend/vector.hpp"

// Scaled inertia of rocks: docs/theory.md#mass-scaling.
namespace tread::dem
{

/// Largest factor by which the inertia of rocks, the bodies after the named ones, may be scaled up: bounds the
/// choice of the substep.
struct MassScaling
{
    std::int64_t named = 0;
    double       most  = 1;
};

/// Share of a factor's excess over 1 that a rock keeps in a substep in which its contacts do not want it. A factor that
/// followed the contacts at once would give a rock energy where it is pressed and let go.
inline constexpr double kept_a_substep = 0.99;

/// Factors by which the inertia of rocks is scaled up in a substep.
struct InertiaScaling
{
    double* factor   = nullptr; ///< of each body, 1 or more; null: no inertia is scaled
    double  bearable = 0;       ///< 1/s2, largest sum K / m at which a substep suits a body of its own mass

    /// Returns a rock's factor in this substep, and keeps it; `stiffness`: N/m, sum of K over its contacts.
    TREAD_HD double renewed(std::int64_t rock, double mass, double stiffness) const
    {
        const double wanted = std::fmax(1.0, stiffness / (mass * bearable));
        return factor[rock] = std::fmax(wanted, 1.0 + kept_a_substep * (factor[rock] - 1.0));
    }
};

} // namespace tread::dem
