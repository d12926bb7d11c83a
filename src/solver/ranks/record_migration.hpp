#pragma once

#include <cstdint>
#include <vector>

#include "base/communicator.hpp"
#include "kernels/dem/pairs/pairs.hpp"
#include "solver/ranks/body_holding.hpp"

// Contact records migrate with the body whose owner evaluates the contact.
namespace tread::solver
{

/// Body of a pair whose owner evaluates the contact. `is_large`: dem::BodySizes::is_large, one entry per body.
std::int64_t deciding_body(const std::vector<std::int32_t>& is_large, std::uint64_t key);

/// Sends records of the previous list (Pairs::last) to the new owners of bodies that leave this rank, and merges
/// those that arrive. Collective.
template<class Exec>
void migrate_records(const Communicator& communicator, dem::Pairs<Exec>& pairs,
                     const std::vector<std::int32_t>& is_large, const std::vector<BodyHolding>& decided);

} // namespace tread::solver
