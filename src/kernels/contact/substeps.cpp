#include "kernels/contact/substeps.hpp"

#include "kernels/dem/contact/body_contact.hpp"

namespace tread::contact
{

void run_substeps(const Cpu& cpu, PointContact<Cpu>& contact, const PointBodyLaw& law, const dem::BodyStep<Cpu>& step,
                  std::int64_t count)
{
    for (std::int64_t done = 0; done < count; ++done)
    {
        substep(cpu, contact, step.bodies, law, step.motion.dt);
        if (step.pairs.key.size() > 0) { evaluate_contacts(cpu, step.pairs, step.bodies, step.law, step.motion.dt); }
        move_bodies(cpu, step);
    }
}

} // namespace tread::contact
