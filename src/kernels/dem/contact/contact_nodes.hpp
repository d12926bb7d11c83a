#pragma once

#include "kernels/dem/pairs/pairs.hpp"

// Lists of the nodes of every pair that may enter the other body, in the order of the template's nodes, those of the
// first body first. The list is complete while no body moves further than pairs.displacement.allowed. Pairs of exact
// spheres, and of a sphere and a wall, have no nodes.
namespace tread::dem
{

/// Sets pairs.nodes.first[p] to the number of nodes of pair p, or to -1 for exact spheres, which touch without nodes.
/// Fills pairs.search.near, so that list_contact_nodes need not look for them again.
template<class Exec>
void count_contact_nodes(const Exec&, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law);

/// Fills pairs.nodes.node; pairs.nodes.first must already hold the start of each pair's run, and pairs.search.counted
/// the place of each pair in pairs.search.near.
template<class Exec>
void list_contact_nodes(const Exec&, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law);

/// Pairs with more listed nodes than this, and pairs in several patches, get lanes of their own on a GPU, because other
/// pairs would wait for them.
inline constexpr std::int32_t many_nodes = 64;

/// Whether a pair has many nodes. The result is constant while the list holds, although patches pass nodes to each
/// other.
TREAD_HD bool has_many_nodes(const PairsView& pairs, std::int64_t p)
{
    const std::uint64_t key = pairs.key[p];
    return pairs.first_node[p + 1] - pairs.first_node[p] > many_nodes || whole_pair(key) != key ||
           (p + 1 < pairs.count && same_pair(pairs.key[p + 1], key));
}

/// Fills pairs.nodes.many once the list of pairs is complete; does nothing on the CPU.
template<class Exec>
void list_pairs_of_many_nodes(const Exec&, Pairs<Exec>& pairs);

/// Computes pairs.nodes.found and inside for every listed node at the bodies' present positions.
template<class Exec>
void evaluate_nodes(const Exec&, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law);

} // namespace tread::dem
