#pragma once

#include <cstdint>

#include "backend/vector.hpp"
#include "kernels/dem/templates.hpp"

namespace tread::dem
{

/// How bodies may move while a list of pairs is valid: each may drift at a velocity of its own for a while, and be
/// displaced from there.
struct AllowedMotion
{
    const double*       displacement = nullptr; ///< m, of any point of the body; null: there is no list
    const Vec3<double>* drift        = nullptr; ///< m/s; null: no body drifts
    const double*       span         = nullptr; ///< s, for which bodies may drift

    TREAD_HD bool drifts(std::int64_t b) const { return drift != nullptr && drift[b].squaredNorm() > 0; }

    /// How far a body drifts, m.
    TREAD_HD double drift_of(std::int64_t b) const { return drift == nullptr ? 0.0 : drift[b].norm() * *span; }

    /// How far any point of a body goes, m.
    TREAD_HD double way_of(std::int64_t b) const { return displacement[b] + drift_of(b); }

    /// How far two bodies drift towards each other at most, m.
    TREAD_HD double drift_of(std::int64_t a, std::int64_t b) const
    {
        return drift == nullptr ? 0.0 : (drift[a] - drift[b]).norm() * *span;
    }
};

/// Places of the bodies when their pairs were found, and how they may move until that is done again.
struct ListedPlaces
{
    const Vec3<double>* position    = nullptr; ///< m
    const Quat*         orientation = nullptr;
    AllowedMotion       allowed;
    double              age = 0; ///< s, since then
};

/// How far bodies may move before pairs are found again. After every `batch` substeps of a step those that move look
/// two batches ahead; a body that may be too far by then leaves one more batch to the list
/// (largest_displacement_ahead).
struct DisplacementLimit
{
    ListedPlaces        listed; ///< its age is that before the step's first substep; without a list nobody looks
    const TemplateView* templates = nullptr;
    double              dt        = 0;       ///< s, of a substep
    std::int32_t        batch     = 1;       ///< substeps
    std::int32_t        substeps  = 0;       ///< of the step
    std::int32_t*       last      = nullptr; ///< the last substep of the step with this list; 0: not known yet

    std::int32_t  substep  = 1;       ///< number of the present one in the step, from 1
    std::int32_t* repeated = nullptr; ///< where one launch repeats substeps: that number instead
};

} // namespace tread::dem
