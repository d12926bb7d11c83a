#pragma once

#include <set>
#include <string>

namespace tread::test
{

/// Names of the communicating MPI functions that this program has called since the set was last cleared. Not
/// thread-safe.
std::set<std::string>& mpi_calls();

} // namespace tread::test
