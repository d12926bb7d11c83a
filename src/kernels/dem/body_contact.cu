#include "kernels/dem/body_contact_impl.hpp"
#include "kernels/dem/warp_lanes.cuh"

namespace tread::dem
{
namespace
{

constexpr int pair_threads = 128, pair_blocks_an_sm = 2;

/// Reads or writes `count` records of a block together, so that neighbouring threads touch neighbouring words: a record
/// is many words long, and a thread that reads one alone touches a line for each.
template<class T>
__device__ void copy_words(double* to, const double* from, std::int64_t count)
{
    static_assert(sizeof(T) % sizeof(double) == 0);
    constexpr int words = sizeof(T) / sizeof(double);
    for (std::int64_t i = threadIdx.x; i < count * words; i += pair_threads) { to[i] = from[i]; }
}

template<class Meet>
struct EvaluateBlock
{
    body_contact::EvaluatePair<Meet> evaluate;

    __device__ void operator()(std::int64_t block) const
    {
        __shared__ double  shared[pair_threads * sizeof(PairResponse) / sizeof(double)];
        const PairsView&   pairs = evaluate.pairs;
        const std::int64_t begin = block * pair_threads, p = begin + threadIdx.x;
        const std::int64_t count = min(static_cast<long>(pair_threads), static_cast<long>(pairs.count - begin));
        const bool         mine  = p < pairs.count;

        auto* patches   = reinterpret_cast<Patch*>(shared);
        auto* responses = reinterpret_cast<PairResponse*>(shared);
        copy_words<Patch>(shared, reinterpret_cast<const double*>(pairs.patch + begin), count);
        __syncthreads();
        PairResponse response = no_response();
        if (mine)
        {
            response      = evaluate.respond_of(p, OneLane{}, patches[threadIdx.x]);
            pairs.peak[p] = fmax(pairs.peak[p], response.overlap);
        }
        __syncthreads();
        copy_words<Patch>(reinterpret_cast<double*>(pairs.patch + begin), shared, count);
        __syncthreads();
        if (mine) { responses[threadIdx.x] = response; }
        __syncthreads();
        copy_words<PairResponse>(reinterpret_cast<double*>(pairs.response + begin), shared, count);
    }
};

} // namespace

void evaluate_contacts(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law, double dt)
{
    const std::int64_t blocks = (pairs.key.size() + pair_threads - 1) / pair_threads;
    by_narrow_phase(law,
                    [&](const auto& meet)
                    {
                        const body_contact::EvaluatePair evaluate{meet, bodies, law, pairs.view(), dt};
                        for_each_block<pair_threads, pair_blocks_an_sm>(gpu, "body contacts", blocks,
                                                                        EvaluateBlock{evaluate});
                    });
}

} // namespace tread::dem
