#pragma once

#include "kernels/dem/pairs.hpp"

namespace tread::dem
{

/// Lists of every pair the nodes that may come inside the other side within dt (s), in the order of the template's
/// nodes, first those of the first body: pairs.first_node and pairs.node. None is missed while no body moves further
/// than reach_of (pairs_kern.hpp) allows. Exact spheres among themselves and against walls have none.
void list_contact_nodes(const Cpu&, Pairs<Cpu>& pairs, const BodiesView& bodies, const BodyLaw& law, double dt);
void list_contact_nodes(const Gpu&, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law, double dt);

} // namespace tread::dem
