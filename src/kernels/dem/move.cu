#include "kernels/dem/move_impl.hpp"
#include "kernels/dem/warp_lanes.cuh"

namespace tread::dem
{
namespace
{

constexpr int threads = 128, blocks_an_sm = 4; // of moving: registers for so many

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

/// Lanes share a body where there are too few bodies to fill the device: they gather side by side, one moves it.
template<int lanes, class Move>
struct MoveGroups
{
    Move         move;
    std::int64_t bodies;

    static constexpr int groups = threads / lanes;

    __device__ void operator()(std::int64_t block) const
    {
        const std::int64_t b = block * groups + threadIdx.x / lanes;
        if (b < bodies) { move(b, GroupLanes<lanes>{}); }
    }
};

template<int lanes, class Move>
void move_with_lanes(const Gpu& gpu, std::int64_t bodies, const Move& move)
{
    constexpr int groups = MoveGroups<lanes, Move>::groups;
    for_each_block<threads, blocks_an_sm>(gpu, "move bodies", (bodies + groups - 1) / groups,
                                          MoveGroups<lanes, Move>{move, bodies});
}

} // namespace

void move_bodies(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies, BodyTotal* totals,
                 const NamedImpulses& named, const Motion& motion)
{
    constexpr std::int64_t   few = 10000;
    const moving::GatherBody gather{bodies, pairs.view(), totals, motion.dt};
    for_each_group<warp_size>(gpu, "gather large bodies", pairs.large.size(), GatherLarge{gather, pairs.large.data()});
    moving::with_move(gather, pairs.is_large.data(), named, motion,
                      [&](const auto& move)
                      {
                          if (bodies.count < few) { move_with_lanes<4>(gpu, bodies.count, move); }
                          else { move_with_lanes<1>(gpu, bodies.count, move); }
                      });
}

} // namespace tread::dem
