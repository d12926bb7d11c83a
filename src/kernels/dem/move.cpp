#include "backend/launch.hpp"
#include "kernels/dem/move_impl.hpp"

namespace tread::dem
{

void move_bodies(const Cpu& cpu, Pairs<Cpu>& pairs, const BodiesView& bodies, BodyTotal* totals,
                 const NamedImpulses& named, const Motion& motion)
{
    const moving::GatherBody gather{bodies, pairs.view(), totals, motion.dt};
    const std::int32_t*      is_large = pairs.is_large.data();
    for_each(cpu, "gather large bodies", pairs.large.size(),
             [=, large = pairs.large.data()](std::int64_t l) { gather(large[l], OneLane{}); });
    moving::with_integration(
        bodies, totals, motion,
        [&](const auto& integrate) {
            for_each(cpu, "move bodies", bodies.count, moving::Move{gather, is_large, named, integrate});
        });
}

} // namespace tread::dem
