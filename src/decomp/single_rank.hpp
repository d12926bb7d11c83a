#pragma once

#include <string>

#include "base/communicator.hpp"

namespace tread::decomp
{

/// EnvironmentError on more than one rank: `what` ("scenes with bodies") is done on one only, and it is said instead of
/// doing the same on each.
void require_single_rank(const Communicator& communicator, const std::string& what);

} // namespace tread::decomp
