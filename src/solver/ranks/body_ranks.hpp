#pragma once

#include <cstdint>
#include <vector>

#include "backend/fetched_array.hpp"
#include "decomp/balance.hpp"
#include "decomp/decomposition.hpp"
#include "decomp/exchange.hpp"
#include "kernels/contact/borders.hpp"
#include "kernels/dem/bodies.hpp"
#include "solver/ranks/body_blocks.hpp"
#include "solver/ranks/body_owners.hpp"
#include "solver/ranks/record_migration.hpp"
#include "solver/ranks/shared_bodies.hpp"
#include "solver/state_file.hpp"
#include "world/world.hpp"

namespace tread::solver
{

/// Distribution of a scene's bodies over the ranks: moves states and contact records to the ranks that BodyOwners
/// decides on, and keeps SharedBodies in step. Calls are collective unless a comment says otherwise.
template<class Exec>
class BodyRanks
{
public:
    /// Sets the owners; there are no ghosts before the first assign_owners(). `sand_reach`: m, distance beyond a
    /// body's surface within which the owner of sand must hold the body.
    BodyRanks(decomp::Decomposition<Exec>& decomposition, const world::World& world, double sand_reach,
              dem::Bodies<Exec>& bodies);

    /// Sums the requested displacements of all ranks' bodies. Call between dem::request_displacement and
    /// dem::allow_displacement.
    void sum_wanted_displacement(dem::Pairs<Exec>& pairs) const;

    /// Moves bodies, with their contact records, to the ranks that now own them, and sends ghosts to the ranks where
    /// they may be in contact. Call between dem::allow_displacement and dem::list_pairs.
    void assign_owners(dem::Bodies<Exec>& bodies, dem::Pairs<Exec>& pairs);

    /// Saves or loads who owns and who holds which body, as part of an exact state; the owners of pages are loaded
    /// before.
    void transfer(StateFile& file, dem::Bodies<Exec>& bodies);

    /// Order of the bodies in files; valid until they change owners.
    BodyBlocks blocks() const { return {communicator(), owners_.owned(), owners_.roles().size()}; }

    // Not collective.
    /// Predicted work of this rank's bodies, in points, in total and by page.
    double load() const;
    void   add_loads(const dem::Bodies<Exec>& bodies, decomp::PageLoads& loads) const;

    bool pages_have_changed() const { return owners_.pages_version() != decomposition_.owners.changes(); }
    bool owns(std::int64_t body) const { return owners_.owns(body); }

    SharedBodies<Exec>& shared() { return shared_; }
    bool                shares() const { return shared_.count() > 0; }
    const Communicator& communicator() const { return decomposition_.communicator; }

private:
    void         follow_pages();
    BodyHoldings decide(dem::Bodies<Exec>& bodies, dem::Pairs<Exec>& pairs);
    RankLists    states_to_send(const BodyHoldings& decided) const;
    void         send_states(const RankLists& leaving, const RankLists& arriving, const decomp::Columns& columns);

    decomp::Decomposition<Exec>&            decomposition_;
    Exec                                    exec_;
    double                                  sand_reach_; ///< m
    BodyOwners                              owners_;
    SharedBodies<Exec>                      shared_;
    BodyHoldings                            held_; ///< bodies that this rank shares or has just got, ascending
    contact::Borders<Exec>                  borders_;
    FetchedArray<Exec, std::int32_t>        border_body_;
    FetchedArray<Exec, contact::BorderBody> border_ball_;
    std::vector<std::int32_t>               is_large_; ///< by body, from Pairs; empty before assign_owners()
    RecordMigration<Exec>                   records_;
    decomp::Exchange<Exec>                  states_;
    Array<Exec, std::int32_t>               arriving_;
};

} // namespace tread::solver
