#pragma once

#include "base/communicator.hpp"

namespace tread::decomp
{

/// EnvironmentError on more than one rank: this version computes on one, and says so instead of computing the same
/// scene on each.
void require_single_rank(const Communicator& communicator);

} // namespace tread::decomp
