#include "kernels/contact/substeps.hpp"

#include "backend/instantiate.hpp"
#include "kernels/dem/contact/body_contact.hpp"

namespace tread::contact
{

template<class Exec>
bool worth_one_launch(const Exec&, PointContact<Exec>&, const dem::BodyStep<Exec>&)
{
    return false;
}

template<class Exec>
void run_substeps(const Exec& cpu, PointContact<Exec>& contact, const PointBodyLaw& law,
                  const dem::BodyStep<Exec>& step, std::int64_t count)
{
    for (std::int64_t done = 0; done < count; ++done)
    {
        substep(cpu, contact, step.bodies, law, step.motion.dt);
        if (step.pairs.key.size() > 0) { evaluate_contacts(cpu, step.pairs, step.bodies, step.law, step.motion.dt); }
        move_bodies(cpu, step);
    }
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template bool worth_one_launch(const Exec&, PointContact<Exec>&, const dem::BodyStep<Exec>&);                      \
    template void run_substeps(const Exec&, PointContact<Exec>&, const PointBodyLaw&, const dem::BodyStep<Exec>&,      \
                               std::int64_t)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::contact
