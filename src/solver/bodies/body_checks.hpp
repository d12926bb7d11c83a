#pragma once

#include "kernels/dem/motion/impulses.hpp"
#include "kernels/dem/pairs/displacement_tracker.hpp"
#include "solver/bodies/body_state.hpp"
#include "solver/time_step.hpp"

// Checks that stop a run with an invalid state of bodies. Each throws a NumericalError that names time (s), body, value
// and limit. Not collective unless a comment says otherwise: see check_on_ranks.
namespace tread::solver
{

/// Throws for the first body whose position, velocity or force is not finite.
template<class Exec>
void require_finite(const BodyState<Exec>& state, double time);

/// Throws if a contact is deeper than its law allows. `overlap`: largest overlap over radius, by dem::largest_overlap
/// just before.
template<class Exec>
void require_shallow(BodyState<Exec>& state, double overlap, double time);

/// Throws after a step without checks if a body may have touched another that the pair list lacks. `share`: largest
/// displacement over the allowed one, by dem::largest_displacement just before.
template<class Exec>
void require_listed(const BodyState<Exec>& state, const dem::DisplacementTracker<Exec>& displacements, double share,
                    double time);

/// Throws if a body moves so far in a substep (s) that it may pass through the smallest body without contact. `speed`:
/// m/s, the largest of `activity`.
template<class Exec>
void require_resolved(const BodyState<Exec>& state, const Array<Exec, dem::BodyActivity>& activity, double speed,
                      double substep, double time);

/// Throws: a step would take too many substeps; names the body that demands them. Collective.
template<class Exec>
[[noreturn]] void refuse_substeps(BodyState<Exec>& state, const TimeStep& step, const Pace& pace, double time);

} // namespace tread::solver
