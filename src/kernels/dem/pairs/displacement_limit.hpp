#pragma once

#include <cstdint>

#include "backend/vector.hpp"
#include "kernels/dem/templates.hpp"

namespace tread::dem
{

/// Places of the bodies when their pairs were found, and how far they may move until that is done again.
struct ListedPlaces
{
    const Vec3<double>* position    = nullptr; ///< m
    const Quat*         orientation = nullptr;
    const double*       allowed     = nullptr; ///< m, of any point of the body; null: there is no list
};

/// How far bodies may move before pairs are found again. After every `batch` substeps of a step those that move look
/// two batches ahead; a body that may be too far by then leaves one more batch to the list
/// (largest_displacement_ahead).
struct DisplacementLimit
{
    ListedPlaces        listed; ///< without `allowed` nobody looks
    const TemplateView* templates = nullptr;
    double              dt        = 0;       ///< s, of a substep
    std::int32_t        batch     = 1;       ///< substeps
    std::int32_t        substeps  = 0;       ///< of the step
    std::int32_t*       last      = nullptr; ///< the last substep of the step with this list; 0: not known yet

    std::int32_t  substep  = 1;       ///< number of the present one in the step, from 1
    std::int32_t* repeated = nullptr; ///< where one launch repeats substeps: that number instead
};

} // namespace tread::dem
