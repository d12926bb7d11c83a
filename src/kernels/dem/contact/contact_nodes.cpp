#include "backend/instantiate.hpp"
#include "backend/launch.hpp"
#include "kernels/dem/contact/contact_nodes_impl.hpp"

namespace tread::dem
{
namespace
{

template<class Item>
void for_each_pair(const Cpu& cpu, const char* name, std::int64_t pairs, const Item& item)
{
    constexpr std::int64_t worth_threads = 64;
    for_each_heavy(
        cpu, name, pairs, [=](std::int64_t p) { item(p, OneLane{}); }, worth_threads);
}

} // namespace

template<class Exec>
void count_contact_nodes(const Exec& cpu, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    place_pair_nodes(cpu, pairs, bodies, law);
    for_each_pair(cpu, "count pair nodes", pairs.key.size(), counting_of_nodes(pairs, bodies, law));
}

template<class Exec>
void list_contact_nodes(const Exec& cpu, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    for_each_pair(cpu, "write pair nodes", pairs.key.size(), writing_of_nodes(pairs, bodies, law));
}

/// Nothing to list: one lane handles any pair.
template<class Exec>
void list_pairs_of_many_nodes(const Exec&, Pairs<Exec>&)
{
}

template<class Exec>
void evaluate_nodes(const Exec& cpu, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    if (pairs.nodes.node.size() == 0) { return; }
    by_narrow_phase(law,
                    [&]<class Meet>(const Meet& meet)
                    {
                        const contact_nodes::EvaluateNodes<Meet> evaluate{meet, bodies.count, law, pairs.view()};
                        constexpr std::int64_t                   worth_threads = 128; // about a millisecond
                        for_each_heavy(
                            cpu, "nodes found", node_words(pairs.nodes.node.size()),
                            [=](std::int64_t word) { evaluate(word, OneLane{}); }, worth_threads);
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
