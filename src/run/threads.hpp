#pragma once

#include "base/communicator.hpp"

namespace tread::run
{

/// Collective: number of OpenMP threads of this rank: `requested`, else OMP_NUM_THREADS, else the machine's cores
/// divided by its ranks.
int choose_threads(const Communicator& communicator, int requested);

} // namespace tread::run
