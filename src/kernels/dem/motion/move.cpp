#include "backend/instantiate.hpp"
#include "backend/launch.hpp"
#include "kernels/dem/joints/joints.hpp"
#include "kernels/dem/motion/move_impl.hpp"

namespace tread::dem
{

template<class Exec>
void share_wrenches(const Exec& cpu, const BodyStep<Exec>& step)
{
    const auto share = moving::make_share(step);
    for_each(cpu, "share wrenches", step.shared.count, [=](std::int64_t i) { share(i, OneLane{}); });
}

template<class Exec>
void move_bodies(const Exec& cpu, const BodyStep<Exec>& step)
{
    if (step.joints.row_count > 0) { solve_joints(cpu, step); }
    const std::int32_t* list  = step.pairs.sleep.list();
    const std::int64_t  count = step.pairs.sleep.listed(step.bodies.count);
    moving::with_move(step,
                      [&](const auto& move) {
                          for_each(cpu, "move bodies", count,
                                   [=](std::int64_t i) { move(list == nullptr ? i : list[i], OneLane{}); });
                      });
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template void share_wrenches(const Exec&, const BodyStep<Exec>&);                                                  \
    template void move_bodies(const Exec&, const BodyStep<Exec>&)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::dem
