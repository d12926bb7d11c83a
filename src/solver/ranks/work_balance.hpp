#pragma once

#include "decomp/balance.hpp"
#include "scene/scene.hpp"

namespace tread::solver
{

class StateFile;

/// Distribution of the work of a run over its ranks: counts steps, and repartitions pages when that is due. Collective.
template<class Exec>
class WorkBalance
{
public:
    WorkBalance(decomp::Decomposition<Exec>& decomposition, const scene::Balance& options);

    /// Whether repartition() should be called before the next step.
    bool is_due() const { return balance_.is_due(steps_); }

    /// Assigns new owners to all pages, if that pays; returns whether it did. `loads`: of this rank.
    bool repartition(const decomp::PageLoads& loads) { return balance_.repartition(loads, steps_); }

    /// Assigns new owners to all pages, for loads that the present ones were not chosen for.
    void repartition_anew(const decomp::PageLoads& loads) { balance_.repartition_anew(loads, steps_); }

    /// Whether the load at this layout version was recorded.
    bool has_noted(std::int64_t version) const { return version == noted_; }

    /// Records this rank's load, in points, at a layout version, and the number of points that migrated to reach it.
    void note(std::int64_t version, double load, std::int64_t points_moved);

    /// Counts a step.
    void pass() { ++steps_; }

    const decomp::BalanceRow& row() const { return balance_.row(); }

    /// Saves to a checkpoint, or loads into a run on as many ranks.
    void transfer(StateFile& file);

private:
    decomp::Balance<Exec> balance_;
    std::int64_t          steps_ = 0; ///< taken
    std::int64_t          noted_ = 0; ///< layout version at the last note()
};

} // namespace tread::solver
