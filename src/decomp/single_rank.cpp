#include "decomp/single_rank.hpp"

#include <fmt/format.h>

namespace tread::decomp
{

void require_single_rank(const Communicator& communicator, const std::string& what)
{
    if (communicator.size() == 1) { return; }
    throw EnvironmentError(
        fmt::format("{} MPI ranks, but {} on one rank only in this version; start it without mpirun, "
                    "or with -n 1",
                    communicator.size(), what));
}

} // namespace tread::decomp
