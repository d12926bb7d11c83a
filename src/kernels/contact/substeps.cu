#include "kernels/contact/substeps.hpp"

#include "kernels/contact/point_contact_impl.hpp"
#include "kernels/contact/reduce_runs.cuh"
#include "kernels/dem/substeps.cuh"

namespace tread::contact
{
namespace
{

using namespace contact_steps;
using dem::repeat_threads;

auto wrenches_part(PointContact<Gpu>& contact, const WrenchOf& wrench)
{
    using Store          = run_steps::StoreSum<dem::ContactWrench>;
    const RunsView parts = contact.candidates.body_parts.of_items.view();
    return Part{parts.count, ReduceRun<dem::ContactWrench, WrenchOf, Store, repeat_threads>{
                                 parts, wrench, {contact.wrench_sums.data()}}};
}

} // namespace

/// Sampled points and rays have launches of their own.
bool worth_one_launch(const Gpu&, PointContact<Gpu>& contact, const dem::BodyStep<Gpu>& step)
{
    constexpr std::int64_t few = 200000;
    return contact.candidates.body.size() < few && contact.slot_first.size() == 0 && step.law.rays == nullptr &&
           dem::worth_one_launch(step.pairs);
}

void run_substeps(const Gpu& gpu, PointContact<Gpu>& contact, const PointBodyLaw& law, const dem::BodyStep<Gpu>& step,
                  std::int64_t count)
{
    if (contact.candidates.body.size() == 0)
    {
        dem::run_substeps(gpu, step, count);
        return;
    }
    const ContactsView        contacts = contact.contacts();
    const PrivatePoints       points   = contact.private_points();
    const double              dt       = step.motion.dt;
    const dem::MeetByDistance meet;
    const auto                respond =
        items<repeat_threads>(contacts.candidates.count, Respond{contacts, points, step.bodies, law, dt});
    const auto sum     = wrenches_part(contact, {contacts, points.position, step.bodies.position});
    const auto advance = items<repeat_threads>(
        points.count, MovePoint{contact.candidates.by_point.view(), contacts, points, law.motion, dt});
    dem::moving::with_damping(step, dem::moving::SumOutside{step.motion.outside},
                              [&](const auto& move)
                              {
                                  repeat<repeat_threads, dem::repeat_blocks_an_sm>(
                                      gpu, "substeps of sand and bodies", count,
                                      sequence(beside(dem::nodes_part(meet, step), respond),
                                               beside(dem::answers_part(meet, step), sum),
                                               beside(dem::move_part(move, step.pairs), advance)));
                              });
}

} // namespace tread::contact
