#pragma once

#include <algorithm>
#include <cmath>

namespace tread::world
{

/// Whether a value of the scene and one of a saved bed differ by more than the rounding of their computation.
inline bool differ(double ours, double theirs)
{
    return ours != theirs && !(std::abs(ours - theirs) <= 1e-9 * std::max(std::abs(ours), std::abs(theirs)));
}

} // namespace tread::world
