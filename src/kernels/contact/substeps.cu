#include "kernels/contact/substeps.hpp"

#include "backend/instantiate.hpp"
#include "kernels/contact/contact_loops.cuh"
#include "kernels/contact/lone_body.cuh"
#include "kernels/contact/point_contact_impl.hpp"
#include "kernels/dem/motion/substeps.cuh"

namespace tread::contact
{
namespace
{

using namespace contact_steps;
using dem::repeat_threads;

constexpr std::int64_t few_bodies = 500; ///< each may use a warp to sum its contacts with sand

auto forces_part(PointContact<Gpu>& contact, const Respond& respond)
{
    const RunsView parts = contact.candidates.body_parts.of_items.view();
    return dem::group_part<repeat_threads, part_lanes>(
        parts.count, RespondPart<Respond>{parts,
                                          respond,
                                          {respond.contacts, respond.points.position, respond.bodies.position},
                                          contact.wrench_sums.data()});
}

/// Whether the scene has a single body without prescribed motions, which touches only sand.
bool is_alone(const dem::BodyStep<Gpu>& step)
{
    return step.bodies.count == 1 && step.bodies.role == nullptr && step.pairs.key.size() == 0 &&
           step.prescribed.motion == nullptr;
}

/// Returns false if it needs more threads than are resident on the device.
bool run_alone(const Gpu& gpu, PointContact<Gpu>& contact, const PointBodyLaw& law, const dem::BodyStep<Gpu>& step,
               std::int64_t count)
{
    constexpr const char* name = "substeps of sand and a body";
    const Respond         respond{contact.contacts(), contact.private_points(), step.bodies, law, step.motion.dt};
    bool                  runs = false;
    dem::moving::without_motions(step, KnownWrench{}, dem::moving::Alone{},
                                 [&]<class Move>(const Move& move)
                                 {
                                     const auto         kernel = lone_body_kernel<Move>;
                                     const std::int64_t blocks =
                                         (respond.points.count + lone_threads - 1) / lone_threads;
                                     runs = blocks <= resident_blocks(name, kernel, lone_threads);
                                     if (!runs) { return; }
                                     const LoneBody<Move> lone{respond,
                                                               contact.candidates.by_point.view(),
                                                               law.motion,
                                                               move,
                                                               step.pairs.body.data(),
                                                               contact.wrench_sums.data()};
                                     launch_together(gpu, name, kernel, blocks, lone_threads, count, lone);
                                 });
    return runs;
}

} // namespace

/// Sampled points and rays need separate launches.
template<class Exec>
bool worth_one_launch(const Exec&, PointContact<Exec>& contact, const dem::BodyStep<Exec>& step)
{
    constexpr std::int64_t few = 200000;
    return contact.candidates.body.size() < few && contact.slot_first.size() == 0 && step.law.rays == nullptr &&
           dem::worth_one_launch(step);
}

template<class Exec>
void run_substeps(const Exec& gpu, PointContact<Exec>& contact, const PointBodyLaw& law,
                  const dem::BodyStep<Exec>& step, std::int64_t count)
{
    if (contact.candidates.body.size() == 0)
    {
        dem::run_substeps(gpu, step, count);
        return;
    }
    if (is_alone(step) && run_alone(gpu, contact, law, step, count)) { return; }
    const ContactsView        contacts = contact.contacts();
    const PrivatePoints       points   = contact.private_points();
    const double              dt       = step.motion.dt;
    const dem::MeetByDistance meet;
    const auto                forces  = forces_part(contact, {contacts, points, step.bodies, law, dt});
    const auto                advance = items<repeat_threads>(
        points.count, MovePoint{contact.candidates.by_point.view(), contacts, points, law.motion, dt});
    const auto run = [&](const auto& moved)
    {
        repeat<repeat_threads, dem::repeat_blocks_an_sm>(gpu, "substeps of sand and bodies", dem::times_of(step, count),
                                                         sequence(beside(dem::nodes_part(meet, step), forces),
                                                                  dem::answers_part(meet, step),
                                                                  beside(moved, advance)));
    };
    dem::moving::with_motions(step, dem::moving::SumOutside{step.motion.outside}, dem::moving::Alone{},
                              [&](const auto& move)
                              {
                                  const std::int64_t bodies = step.bodies.count;
                                  if (step.pairs.sleep.listed(bodies) < few_bodies)
                                  {
                                      run(dem::moved_part<repeat_threads, warp_size>(step.pairs, bodies, move));
                                  }
                                  else { run(dem::move_part(move, step.pairs)); }
                              });
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template bool worth_one_launch(const Exec&, PointContact<Exec>&, const dem::BodyStep<Exec>&);                      \
    template void run_substeps(const Exec&, PointContact<Exec>&, const PointBodyLaw&, const dem::BodyStep<Exec>&,      \
                               std::int64_t)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::contact
