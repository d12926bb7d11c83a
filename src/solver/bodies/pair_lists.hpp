#pragma once

#include <cstdint>
#include <limits>

#include "kernels/dem/pairs/displacement_limit.hpp"
#include "kernels/dem/pairs/displacement_tracker.hpp"
#include "solver/bodies/body_state.hpp"
#include "solver/bodies/unchecked_span.hpp"
#include "solver/time_step.hpp"

namespace tread::solver
{

/// Lifetime of the list of pairs: how far bodies have moved since it was built, and the checks whether it is still
/// valid.
template<class Exec>
struct PairLists
{
    explicit PairLists(const Exec& exec)
        : displacements(exec)
        , substeps(exec, "substeps of a list", 2)
    {
        substeps.fill_zero();
    }

    /// What the present list allows the bodies, as of the last call of take_done.
    dem::ListedPlaces places(const BodyState<Exec>& state) const
    {
        return displacements.listed(state.pairs.displacement.view(), age);
    }

    /// Limit of displacements for the next substep; empty where no substep looks.
    dem::DisplacementLimit limit(BodyState<Exec>& state);

    /// Whether the substeps requested so far end with one in which bodies look ahead.
    bool has_looked() const { return checked_within_step && requested % batch == 0 && requested < of_step; }

    static constexpr std::int64_t endless = std::numeric_limits<std::int64_t>::max();

    /// Number of substeps until bodies look ahead, at least one; endless where none does.
    std::int64_t until_look() const { return checked_within_step ? batch - requested % batch : endless; }

    /// Begins the substeps of a step.
    void begin(const TimeStep& next);

    /// Number of substeps requested since the last call that were done: up to the last that the list serves.
    std::int64_t take_done(const Exec& exec);

    /// Saves or loads the list and the positions of its search, where the state is exact; otherwise the next
    /// update_pairs builds a list.
    void transfer(StateFile& file, BodyState<Exec>& state);

    dem::DisplacementTracker<Exec> displacements;
    bool                           listed              = false; ///< whether pairs were found
    bool                           checked_within_step = false; ///< the substeps of a step look ahead, too
    std::int64_t                   version             = 0;     ///< counts lists
    double                         age                 = 0;     ///< s, of the list after `done` substeps

    bool                      expired    = false; ///< the substeps have ended with the last that the list serves
    std::int32_t              last       = 0;     ///< DisplacementLimit::last as it was read last
    std::int64_t              done       = 0;     ///< substeps of this step
    std::int64_t              requested  = 0;     ///< likewise
    std::int64_t              of_step    = 1;     ///< all substeps of this step
    double                    substep_dt = 0;     ///< s
    std::int64_t              batch      = 1;     ///< DisplacementLimit::batch
    Array<Exec, std::int32_t> substeps;           ///< DisplacementLimit::last and repeated
};

/// Lists pairs of bodies, and of bodies and walls, that may touch within dt (s), and what stiffness to expect of their
/// contacts; rebuilds the list if the old one may have expired. `substeps`: number of substeps in dt; it sets how many
/// steps a new list should remain valid. Returns whether it was rebuilt. The nodes of the list have been evaluated at
/// the bodies' present positions then, by their distance fields. Collective. `unheld`: of bodies that leave this rank;
/// within a step their rows must stay.
template<class Exec>
bool update_pairs(BodyState<Exec>& state, PairLists<Exec>& lists, double dt, double substeps, UnheldRows unheld);

/// Begins the substeps of a step, and chooses whether and how often bodies look ahead in them. `contact_time`: s, the
/// smallest sqrt(m / sum K) of a body, 0 = no contact.
template<class Exec>
void begin_substeps(const BodyState<Exec>& state, PairLists<Exec>& lists, const TimeStep& step,
                    const MotionBound& motion, double contact_time);

/// Call after as many substeps as PairLists::until_look says, on several ranks: a list that is to expire for one does
/// so for all after the same substep. Collective.
template<class Exec>
void agree_on_list(BodyState<Exec>& state, PairLists<Exec>& lists);

/// Number of steps of dt (s) for which the list needs no check; at least one.
template<class Exec>
std::int64_t steps_without_check(const BodyState<Exec>& state, double dt, const MotionBound& motion);

} // namespace tread::solver
