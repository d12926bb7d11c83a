#pragma once

#include "base/communicator.hpp"

namespace tread::run
{

/// Collective: OpenMP threads for this rank: as many as `asked` for, or OMP_NUM_THREADS, or the cores of its machine
/// over the ranks there.
int choose_threads(const Communicator& communicator, int asked);

} // namespace tread::run
