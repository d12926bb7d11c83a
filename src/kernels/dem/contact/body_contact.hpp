#pragma once

#include "kernels/dem/contact/contact_nodes.hpp"

namespace tread::dem
{

/// Computes the response of every listed pair (pairs.answers) from its nodes, which evaluate_nodes has evaluated at the
/// bodies' present positions, and advances its patch by dt (s, of the substep). Allocates nothing.
template<class Exec>
void answer_contacts(const Exec&, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law, double dt);

/// First half of a substep: evaluate_nodes and answer_contacts. move.hpp sums the responses.
template<class Exec>
void evaluate_contacts(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law, double dt)
{
    evaluate_nodes(exec, pairs, bodies, law);
    answer_contacts(exec, pairs, bodies, law, dt);
}

} // namespace tread::dem
