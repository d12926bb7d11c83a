#include "kernels/dem/motion/substeps.hpp"

#include "kernels/dem/contact/body_contact.hpp"

namespace tread::dem
{

void run_substeps(const Cpu& cpu, const BodyStep<Cpu>& step, std::int64_t count)
{
    for (std::int64_t substep = 0; substep < count; ++substep)
    {
        evaluate_contacts(cpu, step.pairs, step.bodies, step.law, step.motion.dt);
        move_bodies(cpu, step);
    }
}

} // namespace tread::dem
