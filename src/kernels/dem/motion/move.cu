#include "backend/instantiate.hpp"
#include "kernels/dem/contact/lane_parts.cuh"
#include "kernels/dem/joints/joints.hpp"
#include "kernels/dem/motion/move_impl.hpp"

namespace tread::dem
{
namespace
{

template<int lanes, class Move>
void launch(const Gpu& gpu, const BodyStep<Gpu>& step, const Move& move)
{
    constexpr int threads = 128, blocks_an_sm = 4; // limits the registers
    const auto    part = body_part<threads, lanes>(step.bodies.count, step.pairs, move);
    for_each_block<threads, blocks_an_sm>(gpu, "move bodies", part.blocks, part.f);
}

} // namespace

template<class Exec>
void share_wrenches(const Exec& gpu, const BodyStep<Exec>& step)
{
    constexpr int threads = 128;
    const auto    part    = group_part<threads, warp_size>(step.shared.count, moving::make_share(step));
    for_each_block<threads>(gpu, "share wrenches", part.blocks, part.f);
}

template<class Exec>
void move_bodies(const Exec& gpu, const BodyStep<Exec>& step)
{
    constexpr std::int64_t few = 10000; // too few to fill the device: several lanes gather, one moves
    if (step.joints.row_count > 0) { solve_joints(gpu, step); }
    moving::with_move(step,
                      [&](const auto& move)
                      {
                          if (step.pairs.sleep.listed(step.bodies.count) < few) { launch<4>(gpu, step, move); }
                          else { launch<1>(gpu, step, move); }
                      });
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template void share_wrenches(const Exec&, const BodyStep<Exec>&);                                                  \
    template void move_bodies(const Exec&, const BodyStep<Exec>&)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::dem
