#include "kernels/dem/contact_limits_impl.hpp"
#include "kernels/dem/pair_block.cuh"

namespace tread::dem
{
namespace
{

using namespace pair_block;

template<int size>
struct AnticipateBlock
{
    AnticipatePair anticipate;

    __device__ void operator()(std::int64_t block) const
    {
        __shared__ Raw<PairsOfBlock<size>> raw;
        PairsOfBlock<size>&                shared = raw.value;
        const auto&                        pairs  = anticipate.evaluate;
        const PairRun<size>                run(block, pairs.pairs.count);
        set_up(pairs, run, shared);
        __syncthreads();
        if (static_cast<int>(threadIdx.x) < run.count)
        {
            anticipate.let_fall(run.begin + threadIdx.x, shared.setting[threadIdx.x]);
        }
        __syncthreads();
        const OwnPair<size> own(run, shared);
        double              found = 0;
        for (std::int32_t base = shared.first[0]; base < shared.first[run.count]; base += PairsOfBlock<size>::room)
        {
            look_up(pairs, run, base, shared);
            own(base, shared,
                [&](const NodeInField& node) { found += anticipate.stiffness(shared.setting[own.pair], node); });
        }
        found = own.lanes.sum(found);
        if (own.exists && own.lanes.lane() == 0) { anticipate.entering[run.begin + own.pair] = found; }
    }
};

} // namespace

void expect_contacts(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law,
                     const Vec3<double>& gravity, double dt)
{
    const AnticipatePair anticipate = contact_limits::anticipate(pairs, bodies, law, gravity, dt);
    const std::int64_t   count      = pairs.key.size();
    if (pairs.node.size() == 0) { pairs.measure.fill_zero(); }
    else
    {
        by_count(count,
                 [&](auto size)
                 {
                     for_each_block<threads, blocks_an_sm>(gpu, "anticipated contacts", (count + size - 1) / size,
                                                           AnticipateBlock<size>{anticipate});
                 });
    }
    contact_limits::add_up(gpu, pairs, bodies, law);
}

double smallest_contact_time(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies)
{
    return contact_limits::contact_time(gpu, pairs, bodies);
}

double largest_overlap(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    return contact_limits::overlap(gpu, pairs, bodies, law);
}

} // namespace tread::dem
