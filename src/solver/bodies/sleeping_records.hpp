#pragma once

#include "solver/bodies/body_state.hpp"

namespace tread::solver
{

class StateFile;

/// Saves or loads the pairs of sleepers, after the list of pairs. Where the state is not exact, all wake: the records
/// of their pairs are then those of the previous list, as transfer_contacts has left it. Collective.
template<class Exec>
void transfer_sleeping_pairs(BodyState<Exec>& state, StateFile& file);

} // namespace tread::solver
