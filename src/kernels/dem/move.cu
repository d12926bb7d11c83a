#include "kernels/dem/move_impl.hpp"
#include "kernels/dem/warp_lanes.cuh"

namespace tread::dem
{
namespace
{

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
    const std::int32_t*      is_large = pairs.is_large.data();
    for_each_group<warp_size>(gpu, "gather large bodies", pairs.large.size(), GatherLarge{gather, pairs.large.data()});
    moving::with_integration(
        bodies, totals, motion,
        [&](const auto& integrate) {
            for_each(gpu, "move bodies", bodies.count, moving::Move{gather, is_large, named, integrate});
        });
}

} // namespace tread::dem
