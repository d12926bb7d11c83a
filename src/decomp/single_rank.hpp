#pragma once

#include <string>

#include "base/communicator.hpp"

namespace tread::decomp
{

/// EnvironmentError on more than one rank: `what` ("scenes with bodies") supports one rank only, and every rank would
/// otherwise repeat the same work.
void require_single_rank(const Communicator& communicator, const std::string& what);

} // namespace tread::decomp
