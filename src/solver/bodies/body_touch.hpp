#pragma once

#include <vector>

#include "solver/bodies/body_state.hpp"
#include "solver/touch_change.hpp"

// Pairs of bodies, and of bodies and walls, that begin or cease to touch at the border of two phases.
namespace tread::solver
{

/// Adds the elastic energy (J) of this rank's contacts, as of the last substep, to that of their pair of materials:
/// [sides x sides], smaller index first.
template<class Exec>
void add_contact_energies(const BodyState<Exec>& state, std::size_t sides, std::vector<double>& energies);

/// NumericalError where a pair that begins to touch overlaps by more than deepest_new_touch. Call with a list made
/// after the change, in which these pairs have no records. `time`: s; `phase`: that begins. Collective.
template<class Exec>
void require_apart(BodyState<Exec>& state, const TouchChange& change, std::size_t phase, double time);

} // namespace tread::solver
