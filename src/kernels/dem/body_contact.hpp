#pragma once

#include "kernels/dem/pairs.hpp"
#include "kernels/dem/totals.hpp"

namespace tread::dem
{

/// Contacts of all listed pairs at the bodies' present places: adds each body's force, torque and stiffness to what
/// stands there (integrate.hpp clears them), advances the patches by dt (s, of the substep), and adds wall impulses and
/// losses to the bodies' `totals`. Every sum has a fixed order. Allocates nothing.
void add_body_contacts(const Cpu&, Pairs<Cpu>& pairs, const BodiesView& bodies, const BodyLaw& law, BodyTotal* totals,
                       double dt);
void add_body_contacts(const Gpu&, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law, BodyTotal* totals,
                       double dt);

} // namespace tread::dem
