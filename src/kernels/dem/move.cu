#include "kernels/dem/move_impl.hpp"
#include "kernels/dem/warp_lanes.cuh"

namespace tread::dem
{
namespace
{

constexpr int blocks_an_sm = 4; ///< registers for so many

template<int lanes, class Item>
void launch(const Gpu& gpu, const char* name, std::int64_t count, const Item& item)
{
    for_each_group<lanes, blocks_an_sm>(gpu, name, count, item);
}

} // namespace

void move_bodies(const Gpu& gpu, const BodyStep<Gpu>& step)
{
    constexpr std::int64_t few = 10000; // do not fill the device: lanes gather side by side, one moves
    moving::with_move(step,
                      [&]<class Move>(const Move& move)
                      {
                          const moving::MoveSmall<Move> small{move, step.pairs.is_large.data()};
                          launch<warp_size>(gpu, "move large bodies", step.pairs.large.size(),
                                            moving::MoveLarge<Move>{move, step.pairs.large.data()});
                          if (step.bodies.count < few) { launch<4>(gpu, "move bodies", step.bodies.count, small); }
                          else { launch<1>(gpu, "move bodies", step.bodies.count, small); }
                      });
}

} // namespace tread::dem
