#pragma once

#include "backend/repeat.cuh"
#include "kernels/dem/contact/block_lanes.cuh"
#include "kernels/dem/contact/contact_nodes.hpp"
#include "kernels/dem/contact/warp_lanes.cuh"

// Assignment of items to lanes. Items much longer than the rest get a warp or a block of their own, because the others
// would wait for them.
namespace tread::dem
{

/// Calls f(i, lanes) for i in [0, items).
template<int threads, int lanes, class F>
auto group_part(std::int64_t items, const F& f)
{
    const GroupsOfBlock<threads, lanes, F> block{f, items};
    return Part{block.blocks(), block};
}

template<class F>
struct OfListed
{
    F                   f;
    const std::int32_t* list;

    template<class Lanes>
    __device__ void operator()(std::int64_t i, const Lanes& lanes) const
    {
        f(list[i], lanes);
    }
};

template<class F>
struct OfPairsWithFewNodes
{
    F         f;
    PairsView pairs;

    template<class Lanes>
    __device__ void operator()(std::int64_t p, const Lanes& lanes) const
    {
        if (!has_many_nodes(pairs, p)) { f(p, lanes); }
    }
};

/// Calls f(p, lanes) for every pair.
template<int threads, int lanes, class F>
auto pair_part(const PairsView& pairs, const F& f)
{
    return beside(group_part<threads, warp_size>(pairs.many_count, OfListed<F>{f, pairs.many}),
                  group_part<threads, lanes>(pairs.count, OfPairsWithFewNodes<F>{f, pairs}));
}

template<class F>
struct OfSmallBodies
{
    F                   f;
    const std::int32_t* is_large; ///< null if pairs were never found

    template<class Lanes>
    __device__ void operator()(std::int64_t b, const Lanes& lanes) const
    {
        if (is_large == nullptr || is_large[b] == 0) { f(b, lanes); }
    }
};

/// Calls f for the bodies of a list.
template<class F>
struct OfMoved
{
    F                   f;
    const std::int32_t* list; ///< null: all bodies

    template<class Lanes>
    __device__ void operator()(std::int64_t i, const Lanes& lanes) const
    {
        f(list == nullptr ? i : list[i], lanes);
    }
};

/// Calls f(b, lanes) for every body that substeps compute.
template<int threads, int lanes, class F>
auto moved_part(const Pairs<Gpu>& pairs, std::int64_t bodies, const F& f)
{
    return group_part<threads, lanes>(pairs.sleep.listed(bodies), OfMoved<F>{f, pairs.sleep.list()});
}

/// Does so with a block for each large body: one such as a wheel in a bed of rocks may have thousands of pairs.
template<int threads, int lanes, class F>
auto body_part(std::int64_t bodies, Pairs<Gpu>& pairs, const F& f)
{
    const ItemOfBlock<threads, OfListed<F>> of_large{{f, pairs.sizes.large.data()}};
    return beside(Part{pairs.sizes.large.size(), of_large},
                  moved_part<threads, lanes>(pairs, bodies, OfSmallBodies<F>{f, pairs.sizes.is_large.data()}));
}

} // namespace tread::dem
