#pragma once

#include <cstdint>

#include "backend/async_readback.hpp"
#include "backend/event.hpp"
#include "kernels/dem/pairs/displacement_limit.hpp"
#include "kernels/dem/pairs/displacement_tracker.hpp"
#include "solver/bodies/body_state.hpp"
#include "solver/bodies/unchecked_span.hpp"
#include "solver/time_step.hpp"

namespace tread::solver
{

/// Lifetime of the list of pairs: how far bodies have moved since it was built, the checks whether it is still valid,
/// and their readback.
template<class Exec>
struct PairLists
{
    explicit PairLists(const Exec& exec)
        : displacements(exec)
        , lookahead(exec, "body displacement ahead on the host")
        , lookahead_done(exec)
        , substeps(exec, "substeps of a list", 2)
    {
        substeps.fill_zero();
    }

    /// Limit of displacements for the next substep; empty where no substep looks.
    dem::DisplacementLimit limit(BodyState<Exec>& state);

    /// Whether looks are launches between batches of substeps.
    bool between_batches() const { return checked_within_step && !in_substeps; }

    /// Begins the substeps of a step.
    void begin(const TimeStep& next);

    /// Number of substeps requested since the last call that were done: up to the last that the list serves.
    std::int64_t take_done(const Exec& exec);

    /// Saves or loads the list and the positions of its search, where the state is exact; otherwise the next
    /// update_pairs builds a list.
    void transfer(StateFile& file, BodyState<Exec>& state);

    dem::DisplacementTracker<Exec> displacements;
    AsyncReadback<Exec, double>    lookahead; ///< largest share of an allowed displacement, extrapolated
    Event<Exec>                    lookahead_done;
    bool                           lookahead_pending   = false; ///< a check was requested and not used yet
    bool                           listed              = false; ///< whether pairs were found
    bool                           checked_within_step = false; ///< the list is also checked within the step
    std::int64_t                   partition_version   = 0;     ///< counts assignments of bodies to ranks

    bool                      in_substeps = false; ///< the substeps of this step look ahead themselves
    bool                      expired     = false; ///< the substeps have ended with the last that the list serves
    std::int32_t              last        = 0;     ///< DisplacementLimit::last as it was read last
    std::int64_t              done        = 0;     ///< substeps of this step
    std::int64_t              requested   = 0;     ///< likewise
    std::int64_t              of_step     = 1;     ///< all substeps of this step
    double                    substep_dt  = 0;     ///< s
    std::int64_t              batch       = 1;     ///< DisplacementLimit::batch
    Array<Exec, std::int32_t> substeps;            ///< DisplacementLimit::last and repeated
};

/// Lists pairs of bodies, and of bodies and walls, that may touch within dt (s), and what stiffness to expect of their
/// contacts; rebuilds the list if the old one may have expired. `substeps`: number of substeps in dt; it sets how many
/// steps a new list should remain valid. Returns whether it was rebuilt. Collective.
/// `unheld`: of bodies that leave this rank; within a step their rows must stay.
template<class Exec>
bool update_pairs(BodyState<Exec>& state, PairLists<Exec>& lists, double dt, double substeps, UnheldRows unheld);

/// Chooses whether the list is checked within the step, and returns the number of substeps that may be requested
/// together: all on one rank, where the substeps look ahead themselves. Several ranks have to agree after each batch,
/// by request_lookahead and is_displaced_too_far; both ways a list expires after the same substeps. `contact_time`: s,
/// the smallest sqrt(m / sum K) of a body, 0 = no contact.
template<class Exec>
std::int64_t substeps_without_check(const BodyState<Exec>& state, PairLists<Exec>& lists, const TimeStep& step,
                                    const MotionBound& motion, double contact_time);

/// Number of steps of dt (s) for which the list needs no check; at least one.
template<class Exec>
std::int64_t steps_without_check(const BodyState<Exec>& state, double dt, const MotionBound& motion);

/// Whether the list expired in the last batch of substeps, or, on several ranks, the check requested before that batch
/// says that a body may move too far in the next. Collective; waits for the readback. False if no check was requested:
/// a new list is valid for two batches.
template<class Exec>
bool is_displaced_too_far(const BodyState<Exec>& state, PairLists<Exec>& lists);

/// Requests the check after `done` substeps of a step, for the next two batches, so that the backend computes during
/// the readback.
template<class Exec>
void request_lookahead(BodyState<Exec>& state, PairLists<Exec>& lists, const TimeStep& step, std::int64_t batch,
                       std::int64_t done);

} // namespace tread::solver
