#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "base/communicator.hpp"
#include "kernels/contact/borders.hpp"
#include "kernels/dem/pairs/records.hpp"
#include "solver/ranks/body_holding.hpp"
#include "world/world.hpp"

namespace tread::solver
{

/// Body of a pair whose owner evaluates the contact. `is_large`: dem::BodySizes::is_large, one entry per body.
std::int64_t deciding_body(const std::vector<std::int32_t>& is_large, std::uint64_t key);

/// Contact records migrate with the body whose owner evaluates the contact. Only those reach the host.
template<class Exec>
class RecordMigration
{
public:
    RecordMigration(const Exec& exec, std::size_t bodies);

    /// Sends records of the previous list (Pairs::last) to the new owners of bodies that leave this rank, and merges
    /// those that arrive. Collective.
    void run(const Communicator& communicator, dem::Pairs<Exec>& pairs, const std::vector<std::int32_t>& is_large,
             const BodyHoldings& decided);

private:
    std::vector<world::ContactRecord> take(dem::Pairs<Exec>& pairs, const std::map<std::int64_t, std::size_t>& moved);

    Exec                      exec_;
    Array<Exec, std::int32_t> body_;
    Array<Exec, std::int32_t> leaving_; ///< per body, its place in body_; -1: it stays
};

} // namespace tread::solver
