#include "kernels/dem/body_contact_impl.hpp"
#include "kernels/dem/warp_lanes.cuh"

namespace tread::dem
{
namespace
{

/// Lanes that share a pair: most pairs list about as many nodes.
constexpr int pair_lanes = 8;

/// A thread for an ordinary body, which has a few pairs; a warp for a large one, which may have thousands.
struct GatherOrdinary
{
    body_contact::GatherBody gather;
    const std::int32_t*      is_large;

    __device__ void operator()(std::int64_t b) const
    {
        if (is_large[b] == 0) { gather(b, OneLane{}); }
    }
};

struct GatherLarge
{
    body_contact::GatherBody gather;
    const std::int32_t*      large;

    template<class Lanes>
    __device__ void operator()(std::int64_t l, const Lanes& lanes) const
    {
        gather(large[l], lanes);
    }
};

} // namespace

void add_body_contacts(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law,
                       BodyTotal* totals, double dt)
{
    for_each_group<pair_lanes>(gpu, "body contacts", pairs.key.size(),
                               body_contact::EvaluatePair{bodies, law, pairs.view(), dt});
    const body_contact::GatherBody gather{bodies, pairs.view(), totals, dt};
    for_each(gpu, "gather body contacts", bodies.count, GatherOrdinary{gather, pairs.is_large.data()});
    for_each_group<warp_size>(gpu, "gather large bodies", pairs.large.size(), GatherLarge{gather, pairs.large.data()});
}

} // namespace tread::dem
