#include "kernels/dem/motion/substeps.cuh"

#include "backend/instantiate.hpp"
#include "kernels/dem/contact/body_contact.hpp"

namespace tread::dem
{

template<class Exec>
void run_substeps(const Exec& gpu, const BodyStep<Exec>& step, std::int64_t count)
{
    const bool moves_only = step.pairs.key.size() == 0; // a sequence of one part must not end early
    if (!worth_one_launch(step) || (moves_only && step.limit.last != nullptr))
    {
        each_substep(gpu, step, count,
                     [](const Exec& exec, const BodyStep<Exec>& each)
                     {
                         evaluate_contacts(exec, each.pairs, each.bodies, each.law, each.motion.dt);
                         move_bodies(exec, each);
                     });
        return;
    }
    by_narrow_phase(step.law,
                    [&](const auto& meet)
                    {
                        moving::with_motions(step, moving::NothingOutside{}, moving::Alone{},
                                             [&](const auto& move)
                                             {
                                                 repeat<repeat_threads, repeat_blocks_an_sm>(
                                                     gpu, "substeps of bodies", times_of(step, count),
                                                     sequence(nodes_part(meet, step), answers_part(meet, step),
                                                              move_part(move, step.pairs)));
                                             });
                    });
}

#define TREAD_INSTANTIATE(Exec) template void run_substeps(const Exec&, const BodyStep<Exec>&, std::int64_t)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::dem
