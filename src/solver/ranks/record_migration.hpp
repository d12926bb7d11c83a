#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "base/communicator.hpp"
#include "kernels/contact/borders.hpp"
#include "kernels/dem/pairs/records.hpp"
#include "solver/ranks/body_holding.hpp"
#include "solver/ranks/body_numbers.hpp"
#include "world/world.hpp"

namespace tread::solver
{

/// Row of the body of a pair of rows whose owner evaluates the contact. `is_large`: dem::BodySizes::is_large, one entry
/// per body.
std::int64_t deciding_body(const std::vector<std::int32_t>& is_large, std::uint64_t key);

/// Destination rank of every row whose body leaves rank `here`. `numbers`: of the rows before.
std::map<std::int64_t, std::size_t> destinations(const BodyHoldings& decided, const BodyNumbers& numbers,
                                                 std::int32_t here);

/// Contact records migrate with the body whose owner evaluates the contact. Only those reach the host.
template<class Exec>
class RecordMigration
{
public:
    explicit RecordMigration(const Exec& exec);

    /// Takes the records of the previous list (Pairs::last) that go to the new owners of bodies that leave this rank.
    /// `numbers`: of the present rows.
    void take(const Communicator& communicator, dem::Pairs<Exec>& pairs, const BodyNumbers& numbers,
              const BodyHoldings& decided);

    /// Sends them, and merges those that arrive. `numbers`: of the rows now. Collective.
    void send(const Communicator& communicator, dem::Pairs<Exec>& pairs, const BodyNumbers& numbers);

private:
    Exec                                           exec_;
    Array<Exec, std::int32_t>                      body_;
    Array<Exec, std::int32_t>                      marks_;   ///< by row, its place in body_; -1: it stays
    std::vector<std::vector<world::ContactRecord>> leaving_; ///< by rank; keys are those of the scene
};

} // namespace tread::solver
