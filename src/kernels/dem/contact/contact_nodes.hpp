#pragma once

#include "kernels/dem/pairs/pairs.hpp"

// Of every pair the nodes that may come inside the other side, in the order of the template's nodes, first those of the
// first body. None is missed while no body moves further than pairs.travel. Exact spheres among themselves and against
// walls have none.
namespace tread::dem
{

/// pairs.first_node[p] = how many nodes pair p has, or -1 if it touches without any: exact spheres.
void count_contact_nodes(const Cpu&, Pairs<Cpu>& pairs, const BodiesView& bodies, const BodyLaw& law);
void count_contact_nodes(const Gpu&, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law);

/// Fills pairs.node, when pairs.first_node is where each pair's run begins.
void list_contact_nodes(const Cpu&, Pairs<Cpu>& pairs, const BodiesView& bodies, const BodyLaw& law);
void list_contact_nodes(const Gpu&, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law);

/// Pairs with more listed nodes than this, and those in several patches, are dealt to lanes of their own by a GPU:
/// others would wait for them.
inline constexpr std::int32_t many_nodes = 64;

/// The same as long as the list holds, although patches pass nodes to each other.
TREAD_HD bool has_many_nodes(const PairsView& pairs, std::int64_t p)
{
    const std::uint64_t key = pairs.key[p];
    return pairs.first_node[p + 1] - pairs.first_node[p] > many_nodes || whole_pair(key) != key ||
           (p + 1 < pairs.count && same_pair(pairs.key[p + 1], key));
}

/// Fills pairs.many, when the list of pairs is complete.
inline void list_pairs_of_many_nodes(const Cpu&, Pairs<Cpu>&) {}
void        list_pairs_of_many_nodes(const Gpu&, Pairs<Gpu>& pairs);

/// pairs.found_node and pairs.inside: every node of the list at the bodies' present places.
void look_up_nodes(const Cpu&, Pairs<Cpu>& pairs, const BodiesView& bodies, const BodyLaw& law);
void look_up_nodes(const Gpu&, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law);

} // namespace tread::dem
