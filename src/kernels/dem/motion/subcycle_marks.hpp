#pragma once

#include "kernels/dem/pairs/pairs.hpp"

namespace tread::dem
{

/// Marks in pairs.stiff what is subcycled (subcycle.hpp): pairs of bodies that can move, do not sleep and have a
/// sqrt(m/K) below `shortest` (s), and all bodies of such pairs; K as in smallest_contact_time. Call after
/// expect_contacts. On several ranks the marks of bodies come from this rank's pairs, and go to shared.mark.
template<class Exec>
void mark_stiff(const Exec&, Pairs<Exec>& pairs, const BodiesView& bodies, double shortest, const SharedView& shared);

/// Marks shared bodies by the pairs of all ranks; call after the exchange of shared.mark.
template<class Exec>
void mark_shared_stiff(const Exec&, Pairs<Exec>& pairs, const SharedView& shared);

} // namespace tread::dem
