#pragma once

#include <cstdint>
#include <optional>

#include "kernels/dem/sleep/sleep.hpp"
#include "solver/bodies/body_reports.hpp"
#include "solver/bodies/pair_lists.hpp"

namespace tread::solver
{

/// What decides over the sleep of rocks besides their motion.
struct SleepSettings
{
    double       damping = 0;  ///< of the phase; with any, no rock falls asleep
    std::int64_t phase   = -1; ///< that the rocks last slept in; -1: none
};

/// Allocates the state of rocks that may sleep; the scene has sleep.rock_speed.
template<class Exec>
void begin_sleep(BodyState<Exec>& state);

/// Has rocks fall asleep or be marked to wake with the sand around them, after sleepers().next_bed has been written;
/// the next update_pairs then builds a list. The list of pairs must be valid. `substep`: s, the last one.
template<class Exec>
void follow_beds(BodyState<Exec>& state, PairLists<Exec>& lists, BodyReports<Exec>& reports, double substep);

/// Lets rocks at rest fall asleep and marks those that wake, if that is due; the next update_pairs then builds a list.
/// `substep`: s, the last one. Does nothing where no rock may sleep.
template<class Exec>
void update_sleep(BodyState<Exec>& state, PairLists<Exec>& lists, BodyReports<Exec>& reports,
                  const SleepSettings& settings, double substep);

/// Wakes all rocks if this is another phase than the last: gravity, contacts or damping may be others.
template<class Exec>
void wake_for_phase(BodyState<Exec>& state, PairLists<Exec>& lists, SleepSettings& settings, std::size_t phase);

/// Mean share of the rocks that have slept; empty where none may.
template<class Exec>
std::optional<double> mean_asleep(const BodyState<Exec>& state);

/// Saves or loads who sleeps, after the list of pairs.
template<class Exec>
void transfer_sleep(BodyState<Exec>& state, SleepSettings& settings, StateFile& file);

} // namespace tread::solver
