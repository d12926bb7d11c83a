#include "kernels/dem/motion/substeps.hpp"

#include "backend/instantiate.hpp"
#include "kernels/dem/contact/body_contact.hpp"

namespace tread::dem
{

template<class Exec>
void run_substeps(const Exec& cpu, const BodyStep<Exec>& step, std::int64_t count)
{
    each_substep(cpu, step, count,
                 [](const Exec& exec, const BodyStep<Exec>& each)
                 {
                     evaluate_contacts(exec, each.pairs, each.bodies, each.law, each.motion.dt);
                     move_bodies(exec, each);
                 });
}

#define TREAD_INSTANTIATE(Exec) template void run_substeps(const Exec&, const BodyStep<Exec>&, std::int64_t)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::dem
