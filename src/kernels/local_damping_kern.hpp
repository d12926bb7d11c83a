#pragma once

#include <cmath>

#include "backend/execution.hpp"

namespace tread
{

/// Local damping of one component (Cundall 1987): a force against the velocity of `alpha` (0 to 1) times the acting
/// force.
template<class Real>
TREAD_HD Real local_damping(Real alpha, Real force, Real velocity)
{
    const Real against = velocity > 0 ? Real(-1) : velocity < 0 ? Real(1) : Real(0);
    return alpha * std::abs(force) * against;
}

} // namespace tread
