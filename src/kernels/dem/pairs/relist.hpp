#pragma once

#include "kernels/dem/pairs/pairs.hpp"

// A new list of which most is the last one: only the pairs of bodies that have strayed, or woken, are found anew. Every
// pair was then found with both bodies at their places at the search, of which each body has its own, and with the
// displacement that it was allowed since then; so a list is what a search of all bodies at those places finds, and
// holds as long. These functions take the place of list_pairs on one rank; several deal their bodies out at every list.
namespace tread::dem
{

/// Marks the bodies that have strayed (RelistMark) in pairs.relisting; returns their number, for which it waits.
/// `share`: of its allowed displacement that each body has used (displacement_tracker.hpp).
template<class Exec>
std::int64_t mark_strayed(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const double* share);

/// Lists the pairs as list_pairs does. `at_search`: the bodies at their places at the search, which are the present
/// ones for those that have strayed. Call after allow_displacement.
template<class Exec>
void relist_pairs(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodiesView& at_search,
                  const BodyLaw& law);

} // namespace tread::dem
