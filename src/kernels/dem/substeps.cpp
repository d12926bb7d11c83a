#include "kernels/dem/substeps.hpp"

#include "kernels/dem/body_contact.hpp"

namespace tread::dem
{

void run_substeps(const Cpu& cpu, Pairs<Cpu>& pairs, const BodiesView& bodies, const BodyLaw& law, BodyTotal* totals,
                  const NamedImpulses& named, const Motion& motion, std::int64_t count)
{
    for (std::int64_t substep = 0; substep < count; ++substep)
    {
        evaluate_contacts(cpu, pairs, bodies, law, motion.dt);
        move_bodies(cpu, pairs, bodies, totals, named, motion);
    }
}

} // namespace tread::dem
