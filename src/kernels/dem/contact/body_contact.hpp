#pragma once

#include "kernels/dem/pairs/pairs.hpp"

namespace tread::dem
{

/// First half of a substep: computes the response of every listed pair at the bodies' present positions (pairs.answers)
/// and advances its patch by dt (s, of the substep). move.hpp sums the responses. Allocates nothing.
template<class Exec>
void evaluate_contacts(const Exec&, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law, double dt);

} // namespace tread::dem
