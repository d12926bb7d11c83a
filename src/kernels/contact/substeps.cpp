#include "kernels/contact/substeps.hpp"

#include "backend/instantiate.hpp"
#include "kernels/dem/contact/body_contact.hpp"
#include "kernels/dem/motion/substeps.hpp"

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
    each_substep(cpu, step, count,
                 [&](const Exec& exec, const dem::BodyStep<Exec>& each)
                 {
                     substep(exec, contact, each.bodies, law, each.motion.dt);
                     if (each.pairs.key.size() > 0)
                     {
                         evaluate_contacts(exec, each.pairs, each.bodies, each.law, each.motion.dt);
                     }
                     move_bodies(exec, each);
                 });
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template bool worth_one_launch(const Exec&, PointContact<Exec>&, const dem::BodyStep<Exec>&);                      \
    template void run_substeps(const Exec&, PointContact<Exec>&, const PointBodyLaw&, const dem::BodyStep<Exec>&,      \
                               std::int64_t)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::contact
