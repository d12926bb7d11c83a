#include "backend/launch.hpp"
#include "kernels/dem/move_impl.hpp"

namespace tread::dem
{

void move_bodies(const Cpu& cpu, Pairs<Cpu>& pairs, const BodiesView& bodies, BodyTotal* totals,
                 const NamedImpulses& named, const Motion& motion)
{
    const moving::GatherBody gather{bodies, pairs.view(), totals, motion.dt};
    for_each(cpu, "gather large bodies", pairs.large.size(),
             [=, large = moving::GatherLarge{gather, pairs.large.data()}](std::int64_t l) { large(l, OneLane{}); });
    moving::with_move(gather, pairs.is_large.data(), named, motion,
                      [&](const auto& move)
                      { for_each(cpu, "move bodies", bodies.count, [=](std::int64_t b) { move(b, OneLane{}); }); });
}

} // namespace tread::dem
