#pragma once

#include <cstdint>

#include "backend/vector.hpp"
#include "kernels/dem/templates.hpp"

namespace tread::dem
{

/// How far bodies may move before pairs are found again. Every substep checks it, and whoever moves too far ends the
/// batch of substeps: their contacts would be incomplete from then on.
struct DisplacementLimit
{
    const Vec3<double>* position    = nullptr; ///< m, at the search
    const Quat*         orientation = nullptr; ///< at the search
    const double*       allowed     = nullptr; ///< m, of any point of the body; null: displacements are not checked
    const TemplateView* templates   = nullptr;
    std::int32_t*       reached     = nullptr; ///< substeps of the batch after which a body was beyond; 0: none yet
    std::int32_t        substep     = 1;       ///< this one's number in the batch, the first is 1
};

} // namespace tread::dem
