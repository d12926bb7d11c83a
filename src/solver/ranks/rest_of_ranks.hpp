#pragma once

#include <vector>

#include "base/communicator.hpp"
#include "solver/sand/page_rest.hpp"

namespace tread::solver
{

/// Completes the state of this rank's pages and bodies by that of all other ranks, so that all choose alike; the pages
/// asleep are already those of all. A page with points on several ranks is as fast as the fastest of them. Collective;
/// `communicator` is null on one rank.
void gather_rest(const Communicator* communicator, RestState& state);

/// Returns the bodies of all ranks, of which each gives its own. Collective.
std::vector<BodyReach> bodies_of_ranks(const Communicator* communicator, std::vector<BodyReach> bodies);

} // namespace tread::solver
