#pragma once

#include <cstdint>
#include <optional>
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
#include "solver/ranks/sleeping_pair_migration.hpp"
#include "solver/state_file.hpp"
#include "world/world.hpp"

namespace tread::solver
{

/// Arrays by row that change ranks with bodies.
template<class Exec>
struct RowArrays
{
    dem::Bodies<Exec>&   bodies;
    dem::Pairs<Exec>&    pairs;
    Array<Exec, double>& bounding_radii; ///< m
    Array<Exec, double>* inertia_factor; ///< null where no inertia is scaled
};

/// A change of rows in a backend's memory. For a row without one before, `from` names any.
template<class Exec>
struct RowMoves
{
    explicit RowMoves(const Exec& exec)
        : from(exec, "rows before")
        , to(exec, "rows now")
    {
    }

    Array<Exec, std::int32_t> from;
    Array<Exec, std::int32_t> to;
    std::vector<std::int32_t> gone; ///< rows before whose bodies have gone
    std::vector<std::int32_t> come; ///< rows now that had none before
};

/// Distribution of a scene's bodies over the ranks: moves states and contact records to the ranks that BodyOwners
/// decides on, and keeps SharedBodies in step. Calls are collective unless a comment says otherwise.
template<class Exec>
class BodyRanks
{
public:
    /// Sets the owners; there are no ghosts before the first assign_owners(). `sand_reach`: m, distance beyond a
    /// body's surface within which the owner of sand must hold the body.
    BodyRanks(decomp::Decomposition<Exec>& decomposition, const world::World& world, double sand_reach);

    /// Sums the requested displacements of all ranks' bodies. Call between dem::request_displacement and
    /// dem::allow_displacement.
    void sum_wanted_displacement(dem::Pairs<Exec>& pairs) const;

    /// Moves bodies, with their contact records, to the ranks that now own them, and sends ghosts to the ranks that
    /// hold them from now on. Those that held them before have moved them like the owner, and have their state to the
    /// bit. Call between dem::allow_displacement and dem::list_pairs.
    void assign_owners(const RowArrays<Exec>& arrays, UnheldRows unheld);

    /// Saves or loads who has rows, owns and holds which body, as part of an exact state; the owners of pages are
    /// loaded before. After loading write_rows() is due.
    void transfer(StateFile& file);

    /// Order of the bodies in files; valid until they change owners.
    BodyBlocks blocks() const { return {communicator(), owners_.owned(), owners_.numbers()}; }

    /// Replaces a number in the backend's memory by the largest of all ranks.
    void largest(std::int32_t* number) { decomposition_.transport.largest(number); }

    // Not collective.
    /// Gives every body a row, for a state whose owners are not known. After it write_rows() is due.
    void take_all();

    /// Writes roles and numbers of the rows, whose arrays have their size.
    void write_rows(dem::Bodies<Exec>& bodies);

    /// Prepares shared() for the marks of bodies that may sleep; call before the first assign_owners().
    void begin_sleep() { shared_.begin_marks(decomposition_.transport); }

    /// How the last assign_owners() has changed rows; null where it has not.
    const RowMoves<Exec>* row_moves() const { return moves_ ? &*moves_ : nullptr; }

    /// Predicted work of this rank's bodies, in points, in total and by page. `asleep`: number of them that sleep.
    double load(double asleep) const;
    void   add_loads(const dem::Bodies<Exec>& bodies, decomp::PageLoads& loads) const;

    bool pages_have_changed() const { return owners_.pages_version() != decomposition_.owners.changes(); }
    bool owns(std::int64_t row) const { return owners_.owns(row); }

    const BodyNumbers&  numbers() const { return owners_.numbers(); }
    SharedBodies<Exec>& shared() { return shared_; }
    bool                shares() const { return shared_.count() > 0; }
    const Communicator& communicator() const { return decomposition_.communicator; }

private:
    void                 follow_pages();
    BodyHoldings         own_shared() const;
    BodyHoldings         decide(const RowArrays<Exec>& arrays);
    contact::BorderReach border_reach(const RowArrays<Exec>& arrays);
    void exchange_bodies(const RowArrays<Exec>& arrays, const BodyHoldings& decided, OwnerChanges change,
                         UnheldRows unheld);
    void take_roles(const RowArrays<Exec>& arrays, const BodyHoldings& changes, UnheldRows unheld);
    void move_rows(const RowArrays<Exec>& arrays, RowChange change);
    void move_sleepers(const RowArrays<Exec>& arrays, const RowMoves<Exec>& moves);

    decomp::Decomposition<Exec>&            decomposition_;
    Exec                                    exec_;
    contact::BorderReach                    reach_; ///< that of the decisions that still last
    BodyOwners                              owners_;
    SharedBodies<Exec>                      shared_;
    BodyHoldings                            held_; ///< bodies that this rank shares, ascending
    contact::Borders<Exec>                  borders_;
    FetchedArray<Exec, std::int32_t>        border_body_;
    FetchedArray<Exec, contact::BorderBody> border_ball_;
    RecordMigration<Exec>                   records_;
    SleepingPairMigration<Exec>             sleepers_;
    decomp::Exchange<Exec>                  states_;
    Array<Exec, std::int32_t>               arriving_;
    std::optional<RowMoves<Exec>>           moves_;
};

} // namespace tread::solver
