#pragma once

#include "kernels/dem/pairs/pairs.hpp"

namespace tread::dem
{

/// First half of a substep: what every listed pair answers at the bodies' present places (pairs.answers), its patch
/// advanced by dt (s, of the substep). move.hpp adds the answers up. Allocates nothing.
void evaluate_contacts(const Cpu&, Pairs<Cpu>& pairs, const BodiesView& bodies, const BodyLaw& law, double dt);
void evaluate_contacts(const Gpu&, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law, double dt);

} // namespace tread::dem
