#include "kernels/dem/move_impl.hpp"
#include "kernels/dem/warp_lanes.cuh"

namespace tread::dem
{
void move_bodies(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies, BodyTotal* totals,
                 const NamedImpulses& named, const Motion& motion)
{
    constexpr std::int64_t   few          = 10000; // do not fill the device: lanes gather side by side, one moves
    constexpr int            blocks_an_sm = 4;     // registers for so many
    const moving::GatherBody gather{bodies, pairs.view(), totals, motion.dt};
    for_each_group<warp_size>(gpu, "gather large bodies", pairs.large.size(),
                              moving::GatherLarge{gather, pairs.large.data()});
    moving::with_move(gather, pairs.is_large.data(), named, motion,
                      [&](const auto& move)
                      {
                          if (bodies.count < few)
                          {
                              for_each_group<4, blocks_an_sm>(gpu, "move bodies", bodies.count, move);
                          }
                          else { for_each_group<1, blocks_an_sm>(gpu, "move bodies", bodies.count, move); }
                      });
}

} // namespace tread::dem
