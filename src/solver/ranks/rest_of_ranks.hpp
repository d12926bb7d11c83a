#pragma once

#include "base/communicator.hpp"
#include "solver/sand/page_rest.hpp"

namespace tread::solver
{

/// Completes the state of this rank's pages and bodies by that of all other ranks, so that all choose alike; the pages
/// asleep are already those of all. A page with points on several ranks is as fast as the fastest of them. Collective;
/// `communicator` is null on one rank.
void gather_rest(const Communicator* communicator, RestState& state);

} // namespace tread::solver
