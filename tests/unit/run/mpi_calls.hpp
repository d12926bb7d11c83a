#pragma once

#include <set>
#include <string>

namespace tread::test
{

/// Names of the MPI functions that were called by this program since it was last cleared, of those by which ranks
/// talk to each other. Not for several threads.
std::set<std::string>& mpi_calls();

} // namespace tread::test
