#include "kernels/dem/contact_nodes_impl.hpp"
#include "kernels/dem/warp_lanes.cuh"

namespace tread::dem
{

/// Lanes that share a pair: a cluster of nodes at a time.
constexpr int node_lanes = 32;

void count_contact_nodes(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    by_narrow_phase(law,
                    [&]<class Meet>(const Meet& meet)
                    {
                        const contact_nodes::Walk<Meet> walk{meet, bodies, law, pairs.view()};
                        for_each_group<node_lanes>(gpu, "count pair nodes", pairs.key.size(),
                                                   contact_nodes::CountNodes<Meet>{walk, pairs.first_node.data()});
                    });
}

void list_contact_nodes(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    by_narrow_phase(law,
                    [&]<class Meet>(const Meet& meet)
                    {
                        const contact_nodes::Walk<Meet> walk{meet, bodies, law, pairs.view()};
                        for_each_group<node_lanes>(
                            gpu, "write pair nodes", pairs.key.size(),
                            contact_nodes::WriteNodes<Meet>{walk, pairs.first_node.data(), pairs.node.data()});
                    });
}

namespace
{

struct MarkMany
{
    PairsView     pairs;
    std::int32_t* found; ///< [pairs + 1]

    __device__ void operator()(std::int64_t p) const { found[p] = p < pairs.count && has_many_nodes(pairs, p) ? 1 : 0; }
};

struct WriteMany
{
    const std::int32_t* found; ///< [pairs + 1], after the scan
    std::int32_t*       many;

    __device__ void operator()(std::int64_t p) const
    {
        if (found[p] != found[p + 1]) { many[found[p]] = static_cast<std::int32_t>(p); }
    }
};

} // namespace

void list_pairs_of_many_nodes(const Gpu& gpu, Pairs<Gpu>& pairs)
{
    pairs.many.resize(0);
    if (pairs.node.size() == 0) { return; }
    const std::int64_t count = pairs.key.size();
    pairs.found.resize(count + 1);
    for_each(gpu, "mark pairs of many nodes", count + 1, MarkMany{pairs.view(), pairs.found.data()});
    pairs.many.resize(exclusive_scan(gpu, pairs.found, pairs.sort));
    if (pairs.many.size() == 0) { return; }
    for_each(gpu, "write pairs of many nodes", count, WriteMany{pairs.found.data(), pairs.many.data()});
}

void look_up_nodes(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    if (pairs.node.size() == 0) { return; }
    by_narrow_phase(law,
                    [&]<class Meet>(const Meet& meet)
                    {
                        const contact_nodes::LookUp<Meet> look_up{meet, bodies.count, law, pairs.view()};
                        for_each_group<nodes_of_word, 7>(gpu, "nodes found", node_words(pairs.node.size()), look_up);
                    });
}

} // namespace tread::dem
