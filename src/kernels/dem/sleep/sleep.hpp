#pragma once

#include "kernels/dem/motion/totals.hpp"
#include "kernels/dem/pairs/pairs.hpp"

// Sleep of bodies (docs/sleep.md). A look decides who falls asleep or wakes; both take effect with the next list of
// pairs. Allocates only in scenes where pairs.sleep.wanted. Collective where pairs.sleep.ranks: all holders of a body
// then decide alike about it.
namespace tread::dem
{

/// Allocates the state of `count` bodies, all awake.
template<class Exec>
void begin_sleep(const Exec&, Pairs<Exec>& pairs, Bodies<Exec>& bodies, const BodyRestRule& rule);

/// Result of a look, in bodies of all ranks.
struct SleepCount
{
    double wake;  ///< sleepers that wake
    double tired; ///< awake ones that may fall asleep
    double awake; ///< awake ones, of those that may sleep
};

/// Marks the bodies that may fall asleep and those that wake: by a moving neighbour in the list, or by a change of
/// their mean load. The list of pairs must be valid. Waits for the counts.
template<class Exec>
SleepCount look_at_sleep(const Exec&, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law);

/// Takes pairs.sleep.next_bed as what sand does from now on, and marks the bodies that follow: those at rest in sand
/// that falls asleep, and sleepers all of whose sand wakes. The list of pairs must be valid. Waits for the counts.
template<class Exec>
SleepCount follow_beds(const Exec&, Pairs<Exec>& pairs, const BodiesView& bodies);

/// Begins a new reference of the load of the bodies that sleeping sand has loaded (pairs.sleep.loaded).
template<class Exec>
void renew_watches(const Exec&, Pairs<Exec>& pairs);

/// Stops the bodies marked as tired: their motion counts as work and impulse of what holds them. Their contacts are
/// computed once more at rest and kept, with their records, among pairs.sleep.pairs. The list must then be found anew.
/// `substep`: s, the last one; `gravity`: m/s2.
template<class Exec>
void fall_asleep(const Exec&, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law, BodyTotal* totals,
                 double substep, const Vec3<double>& gravity);

/// Wakes all bodies, whose times at rest begin anew; the list must then be found anew if any slept.
template<class Exec>
void wake_all(Pairs<Exec>& pairs, Bodies<Exec>& bodies);

/// Wakes the marked bodies, those near moving ones, and their neighbours up to waking_rings contacts on. Called by
/// list_pairs, with the cells of the search.
template<class Exec>
void wake_bodies(const Exec&, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law, double cell_size);

/// Drops the pairs of bodies that woke, updates what follows from the sleepers, and lists the bodies of the substeps.
/// Called by list_pairs at its end.
template<class Exec>
void settle_sleepers(const Exec&, Pairs<Exec>& pairs, const BodiesView& bodies);

/// Sums the contacts that hold sleepers anew, after those with sleeping bodies, walls or sand (pairs.sleep.sand) have
/// changed.
template<class Exec>
void hold_sleepers(const Exec&, Pairs<Exec>& pairs, const BodiesView& bodies);

/// Rebuilds what settle_sleepers derives, from loaded pairs and loads.
template<class Exec>
void resume_sleep(const Exec&, Pairs<Exec>& pairs, const BodiesView& bodies);

/// Gives the bodies of sleeping pairs their rows after others have come or gone, as renumber_records does; what follows
/// from them is rebuilt with the next list.
template<class Exec>
void renumber_sleeping_pairs(const Exec&, Pairs<Exec>& pairs, const Array<Exec, std::int32_t>& row, std::int64_t rows);

/// Lists the bodies that substeps compute: awake ones, and sleepers with a listed pair or an external wrench, or that
/// several ranks hold. Not collective.
template<class Exec>
void list_moved_bodies(const Exec&, Pairs<Exec>& pairs, const BodiesView& bodies, const OutsideWrenches& outside);

} // namespace tread::dem
