#pragma once

#include "kernels/dem/pairs/pairs_impl.hpp"

// Steps of resume_list, for both backends; pairs.cpp and pairs.cu provide for_each and instantiate.
namespace tread::dem
{

template<class Exec>
void resume_list(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies)
{
    using namespace pair_steps;
    stage_bodies(exec, pairs, bodies);
    order_again(exec, pairs, bodies);
    pairs.patches.group.resize(pairs.nodes.node.size());
    pairs.patches.node.resize(pairs.nodes.node.size());
    list_pairs_of_many_nodes(exec, pairs);
    release_memory(pairs.search.second_key);
    release_memory(pairs.sort);
    begin_substeps(exec, pairs);
}

} // namespace tread::dem
