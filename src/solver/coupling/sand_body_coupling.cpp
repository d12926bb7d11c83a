#include "solver/coupling/sand_body_coupling.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "backend/instantiate.hpp"
#include "base/errors.hpp"
#include "decomp/messages.hpp"
#include "solver/ranks/over_ranks.hpp"
#include "world/cover.hpp"
#include "world/materials.hpp"

namespace tread::solver
{
namespace
{

/// Skin over the largest point's radius. A wider skin has more candidates, a narrower one more searches: with a body
/// alone that no list bounds, at 0.3 m/s and steps of 1e-5 s, it lasts 60 steps.
constexpr double skin_share = 0.25;

/// The scene's limit, m; 0 where no body is below it, so that contacts use the plain path.
double met_limit(const world::World& world, double limit)
{
    for (std::size_t b = 0; b < world.bodies.size(); ++b)
    {
        const auto& form = world::template_of(world, b);
        if (world.bodies.scale[b] * form.equivalent_radius < limit) { return limit; }
    }
    return 0;
}

} // namespace

template<class Exec, class Real>
SandBodyCoupling<Exec, Real>::SandBodyCoupling(const Exec& exec, const scene::Scene& scene, const world::World& world,
                                               const dem::TemplateView* templates, dem::PairTable pairs,
                                               decomp::Decomposition<Exec>* decomposition)
    : exec_(exec)
    , contact_(exec)
    , asleep_(exec)
    , law_{templates,
           pairs,
           world::hertz_factor(scene.numerics.hertz),
           world::radius_rule(scene.numerics.point_radius),
           world::point_motion(scene.numerics.point_motion),
           0.0}
    , largest_radius_(contact::point_radius(world::largest_volume(world.sand), law_.radius))
    , skin_(skin_share * largest_radius_)
    , named_(world.bodies.named)
    , readback_(exec, "contact summary on the host")
    , communicator_(decomposition == nullptr ? nullptr : &decomposition->communicator)
{
    constexpr std::size_t most = std::size_t{1} << contact::history_body_bits;
    if (world.bodies.size() > most)
    {
        throw NumericalError(fmt::format("{} bodies meet sand: at most {}", world.bodies.size(), most));
    }
    law_.sampled_below = met_limit(world, world::sampled_below(scene, world.sand));
}

template<class Exec, class Real>
void SandBodyCoupling<Exec, Real>::find_candidates(const mpm::PointsView<Real>& points, const mpm::PagesView& pages,
                                                   const dem::BodiesView& bodies, const BodyList& list,
                                                   std::int64_t version, const CandidateSpan& next)
{
    // What sand moved in the last span is known only now: a body may have hit it. The skin is twice the approach.
    used_by_sand_ += std::exchange(span_, next.time) * 2 * next.sand_speed;
    const double nearer  = 2 * next.time * 2 * next.speed; // a body and a point, each at up to twice the speed
    const bool   bounded = list.places.allowed.displacement != nullptr && list.version == list_;
    const double used    = bounded ? std::min(used_, used_by_sand_) : used_;
    if (version != version_ || used + nearer > skin_)
    {
        const double drift = mpm::quadratic_cell_slack * pages.spacing;
        contact::begin_step(exec_, contact_, points, pages, bodies, law_,
                            {next.time, next.speed, drift, largest_radius_, law_.sampled_below, skin_, list.places});
        version_      = version;
        list_         = list.version;
        used_         = 0;
        used_by_sand_ = 0;
        begun_        = true;
    }
    used_ += nearer;
}

template<class Exec, class Real>
void SandBodyCoupling<Exec, Real>::follow_sleep(const SleepChange<Real>& change, const dem::BodiesView& bodies,
                                                dem::SleepingBodies<Exec>& sleepers)
{
    double lost = contact::take_contacts(exec_, contact_, asleep_, change.asleep, change.first_fallen, bodies, law_,
                                         sleepers.loaded.data());
    sum_over_ranks(communicator_, lost);
    loss_at_rest_ += lost;
    contact::return_contacts(exec_, contact_, asleep_, change.awake, change.first_woken);
    sum_asleep(bodies, sleepers);
}

template<class Exec, class Real>
void SandBodyCoupling<Exec, Real>::sum_asleep(const dem::BodiesView& bodies, dem::SleepingBodies<Exec>& sleepers)
{
    contact::sum_sleeping(exec_, asleep_, bodies, sleepers.sand);
    energy_asleep_ = asleep_.energy;
    sum_over_ranks(communicator_, energy_asleep_);
}

template<class Exec, class Real>
void SandBodyCoupling<Exec, Real>::begin_step(const mpm::PointsView<Real>& points)
{
    if (!std::exchange(begun_, false)) { contact::begin_kept_step(exec_, contact_, points, law_); }
}

template<class Exec, class Real>
void SandBodyCoupling<Exec, Real>::substep(const Exec& exec, const dem::BodiesView& bodies, double dt)
{
    contact::substep(exec, contact_, bodies, law_, dt);
}

template<class Exec, class Real>
void SandBodyCoupling<Exec, Real>::run_substeps(dem::BodyStep<Exec> step, std::int64_t count)
{
    step.motion.outside = contact_.wrenches();
    contact::run_substeps(exec_, contact_, law_, step, count);
}

template<class Exec, class Real>
void SandBodyCoupling<Exec, Real>::finish_step(const mpm::PointsView<Real>& points, double dt)
{
    contact::finish_step(exec_, contact_, points, dt);
}

template<class Exec, class Real>
void SandBodyCoupling<Exec, Real>::measure()
{
    if (!requested_) { request_measure(); }
    requested_ = false;
    synchronize(exec_);
    summary_ = any_near() ? readback_.get() : contact::Summary::zero();
    if (communicator_ == nullptr) { return; }
    const auto of_ranks = decomp::gather_values<contact::Summary>(*communicator_, {summary_});
    summary_            = contact::Summary::zero();
    for (const auto& summary : of_ranks) { summary_ = summary_ + summary.front(); }
}

template<class Exec, class Real>
void SandBodyCoupling<Exec, Real>::request_measure()
{
    if (any_near()) { readback_.request(contact::summarise(exec_, contact_, named_)); }
    requested_ = true;
}

#define TREAD_INSTANTIATE(Exec, Real) template class SandBodyCoupling<Exec, Real>
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
