#include "backend/launch.hpp"
#include "kernels/dem/joints/joints.hpp"
#include "kernels/dem/motion/move_impl.hpp"

namespace tread::dem
{

void share_wrenches(const Cpu& cpu, const BodyStep<Cpu>& step)
{
    moving::with_share(
        step, [&](const auto& share)
        { for_each(cpu, "share wrenches", step.shared.count, [=](std::int64_t i) { share(i, OneLane{}); }); });
}

void move_bodies(const Cpu& cpu, const BodyStep<Cpu>& step)
{
    if (step.joints.row_count > 0) { solve_joints(cpu, step); }
    moving::with_move(step,
                      [&](const auto& move) {
                          for_each(cpu, "move bodies", step.bodies.count, [=](std::int64_t b) { move(b, OneLane{}); });
                      });
}

} // namespace tread::dem
