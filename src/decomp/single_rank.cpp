#include "decomp/single_rank.hpp"

#include <fmt/format.h>

namespace tread::decomp
{

void require_single_rank(const Communicator& communicator)
{
    if (communicator.size() == 1) { return; }
    throw EnvironmentError(fmt::format("{} MPI ranks: this version computes on one rank (domain decomposition is not "
                                       "there yet); start it without mpirun, or with -n 1",
                                       communicator.size()));
}

} // namespace tread::decomp
