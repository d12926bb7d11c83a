#pragma once

#include <cstdint>
#include <vector>

#include "base/communicator.hpp"
#include "kernels/dem/pairs/pairs.hpp"
#include "solver/ranks/body_holding.hpp"
#include "solver/ranks/body_numbers.hpp"
#include "world/world.hpp"

namespace tread::solver
{

/// A pair of sleepers on the host.
struct SleepingRecord
{
    world::ContactRecord record;
    dem::HeldContact     contact;
};
using SleepingRecords = std::vector<SleepingRecord>;

/// Pairs of sleepers, by key.
template<class Exec>
SleepingRecords read_sleeping_pairs(const dem::SleepingPairs<Exec>& pairs);

/// Replaces the pairs of sleepers, given in any order; what follows from them is rebuilt with the next list.
template<class Exec>
void write_sleeping_pairs(dem::Pairs<Exec>& pairs, SleepingRecords records);

/// Pairs of sleepers migrate as contact records do (RecordMigration). Sleepers change their owner with their page only.
template<class Exec>
class SleepingPairMigration
{
public:
    /// Takes the pairs that go to the new owners of bodies that leave this rank. `numbers`: of the present rows.
    void take(const Communicator& communicator, dem::Pairs<Exec>& pairs, const BodyNumbers& numbers,
              const BodyHoldings& decided);

    /// Sends them, and adds those that arrive. `numbers`: of the rows now. Collective.
    void send(const Communicator& communicator, dem::Pairs<Exec>& pairs, const BodyNumbers& numbers);

private:
    std::vector<SleepingRecords> leaving_; ///< by rank; keys are those of the scene
};

} // namespace tread::solver
