#include "kernels/dem/move_impl.hpp"
#include "kernels/dem/warp_lanes.cuh"

namespace tread::dem
{
namespace
{

constexpr int body_lanes = 1;

/// A warp for a large body, which may have thousands of pairs.
struct GatherLarge
{
    moving::GatherBody  gather;
    const std::int32_t* large;

    template<class Lanes>
    __device__ void operator()(std::int64_t l, const Lanes& lanes) const
    {
        gather(large[l], lanes);
    }
};

} // namespace

void move_bodies(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies, BodyTotal* totals,
                 const NamedImpulses& named, const Motion& motion)
{
    const moving::GatherBody gather{bodies, pairs.view(), totals, motion.dt};
    for_each_group<warp_size>(gpu, "gather large bodies", pairs.large.size(), GatherLarge{gather, pairs.large.data()});
    moving::with_move(gather, pairs.is_large.data(), named, motion,
                      [&](const auto& move) { for_each_group<body_lanes>(gpu, "move bodies", bodies.count, move); });
}

} // namespace tread::dem
