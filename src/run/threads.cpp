#include "run/threads.hpp"

#include <algorithm>
#include <cstdlib>
#include <thread>

#include <omp.h>

namespace tread::run
{

int choose_threads(const Communicator& communicator, int requested)
{
    // Must precede any return: a launcher may set OMP_NUM_THREADS on some machines only, and the call is collective.
    const int ranks_here = communicator.local_size();
    if (requested > 0) { return requested; }
    if (std::getenv("OMP_NUM_THREADS") != nullptr) { return omp_get_max_threads(); }
    const int cores = static_cast<int>(std::thread::hardware_concurrency());
    return std::max(1, cores / ranks_here);
}

} // namespace tread::run
