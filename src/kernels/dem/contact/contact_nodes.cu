#include "backend/instantiate.hpp"
#include "kernels/dem/contact/contact_nodes_impl.hpp"
#include "kernels/dem/contact/warp_lanes.cuh"
#include "kernels/dem/pairs/select.hpp"

namespace tread::dem
{

/// Number of lanes that share a pair: they process a cluster of nodes at a time.
constexpr int node_lanes = 32;

/// Blocks a multiprocessor, which limits their registers: more blocks hide more of the loads, until registers are
/// stored (docs/decisions/010-neighbour-lists.md).
constexpr int blocks_to_count = 5, blocks_to_write = 7;

template<class Exec>
void count_contact_nodes(const Exec& gpu, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    place_pair_nodes(gpu, pairs, bodies, law);
    for_each_group<node_lanes, blocks_to_count>(gpu, "count pair nodes", pairs.key.size(),
                                                counting_of_nodes(pairs, bodies, law));
}

template<class Exec>
void list_contact_nodes(const Exec& gpu, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    for_each_group<node_lanes, blocks_to_write>(gpu, "write pair nodes", pairs.key.size(),
                                                writing_of_nodes(pairs, bodies, law));
}

namespace
{

struct HasManyNodes
{
    PairsView pairs;

    __device__ bool operator()(std::int64_t p) const { return has_many_nodes(pairs, p); }
};

} // namespace

template<class Exec>
void list_pairs_of_many_nodes(const Exec& gpu, Pairs<Exec>& pairs)
{
    pairs.nodes.many.resize(0);
    if (pairs.nodes.node.size() == 0) { return; }
    select(gpu, "pairs of many nodes", pairs.key.size(), HasManyNodes{pairs.view()}, pairs.search.found, pairs.sort,
           pairs.nodes.many);
}

template<class Exec>
void evaluate_nodes(const Exec& gpu, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    if (pairs.nodes.node.size() == 0) { return; }
    by_narrow_phase(law,
                    [&]<class Meet>(const Meet& meet)
                    {
                        const contact_nodes::EvaluateNodes<Meet> evaluate{meet, bodies.count, law, pairs.view()};
                        for_each_group<nodes_of_word, 7>(gpu, "nodes found", node_words(pairs.nodes.node.size()),
                                                         evaluate);
                    });
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template void count_contact_nodes(const Exec&, Pairs<Exec>&, const BodiesView&, const BodyLaw&);                   \
    template void list_contact_nodes(const Exec&, Pairs<Exec>&, const BodiesView&, const BodyLaw&);                    \
    template void list_pairs_of_many_nodes(const Exec&, Pairs<Exec>&);                                                 \
    template void evaluate_nodes(const Exec&, Pairs<Exec>&, const BodiesView&, const BodyLaw&)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::dem
