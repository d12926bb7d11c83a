#include "run/visits.hpp"

#include <algorithm>
#include <cstring>
#include <memory>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "backend/instantiate.hpp"
#include "run/run_output.hpp"
#include "run/visited_arrays.hpp"
#include "scene/named.hpp"
#include "scene/problems.hpp"
#include "solver/bodies/motion_bounds.hpp"

namespace tread::run
{
namespace
{

/// Index of the table called `name`; InputError, with the nearest one, if there is none.
template<class T>
std::size_t index_in(const char* kind, const std::vector<T>& items, const std::string& name)
{
    const std::size_t index = scene::index_of(items, name);
    if (index < items.size()) { return index; }
    std::vector<std::string> names;
    names.reserve(items.size());
    for (const T& item : items) { names.push_back(item.name); }
    throw InputError(fmt::format("the scene has no {} '{}'{}", kind, name, scene::suggestion(name, names)));
}

/// One visit.
template<class Exec, class Real>
class Present final : public Visit
{
public:
    Present(const world::World& world, TimeLoop<Exec, Real>& loop, VisitedArrays<Exec, Real>& arrays,
            Steering& steering, VisitedImpulses& impulses)
        : world_(world)
        , loop_(loop)
        , arrays_(arrays)
        , steering_(steering)
        , rows_(loop.simulation.named_bodies())
        , joints_(loop.simulation.joints())
        , forces_(rows_.size(), Vec3<double>::Zero())
        , impulses_(impulses)
    {
        VisitedImpulses now{loop.progress.time, {}};
        for (std::size_t b = 0; b < rows_.size(); ++b) { now.of.push_back(loop.simulation.contact_impulse(b)); }
        const double span = now.time - impulses.time;
        for (std::size_t b = 0; b < impulses.of.size() && span > 0; ++b)
        {
            forces_[b] = (now.of[b] - impulses.of[b]) / span;
        }
        impulses = std::move(now);
    }

    VisitTime when() const override
    {
        const RunProgress& progress = loop_.progress;
        const bool         over     = finished(loop_.scene, loop_.phase);
        const std::size_t  phase    = std::min(loop_.phase.index, loop_.scene.phases.size() - 1);
        return {progress.time,
                progress.steps,
                progress.last_dt,
                loop_.scene.phases[phase].name,
                progress.time - loop_.phase.start,
                over};
    }

    VisitedBody body(const std::string& name) override
    {
        const std::size_t b = index_in("[[body]]", loop_.scene.bodies, name);
        return {rows_[b], impulses_.of[b], forces_[b], world_.bodies.mass[b], loop_.rolling_radii[b]};
    }

    solver::JointRow joint(const std::string& name) override
    {
        return joints_[index_in("[[joint]]", loop_.scene.joints, name)];
    }

    std::optional<HostArray> field(const std::string& name) override { return arrays_.find(name); }

    void steer(const std::string& body, const BodySteering& wish) override
    {
        const std::size_t b = index_in("[[body]]", loop_.scene.bodies, body);
        require_running();
        require_steerable(loop_.scene, loop_.phase, b, wish);
        steering_.bodies[b] = wish;
    }

    void steer(const std::string& joint, const MotorSteering& wish) override
    {
        const std::size_t j = index_in("[[joint]]", loop_.scene.joints, joint);
        require_running();
        require_steerable(loop_.scene.joints[j], wish);
        steering_.motors[j] = wish;
    }

private:
    void require_running() const
    {
        if (!finished(loop_.scene, loop_.phase)) { return; }
        throw InputError("the run is over: nothing can be steered");
    }

    const world::World&           world_;
    TimeLoop<Exec, Real>&         loop_;
    VisitedArrays<Exec, Real>&    arrays_;
    Steering&                     steering_;
    std::vector<solver::BodyRow>  rows_;
    std::vector<solver::JointRow> joints_;
    std::vector<Vec3<double>>     forces_;
    const VisitedImpulses&        impulses_;
};

/// Replaces the values by those of rank 0.
template<class T>
void broadcast(const Communicator& communicator, std::vector<T>& values)
{
    static_assert(std::is_trivially_copyable_v<T>);
    if (communicator.size() == 1 || values.empty()) { return; }
    const std::size_t bytes = values.size() * sizeof(T);
    std::string       text(bytes, '\0');
    std::memcpy(text.data(), values.data(), bytes);
    text = communicator.broadcast(text);
    std::memcpy(values.data(), text.data(), bytes);
}

bool any(const Steering& steering)
{
    const auto is_set = [](const auto& wish) { return wish.has_value(); };
    return std::any_of(steering.bodies.begin(), steering.bodies.end(), is_set) ||
           std::any_of(steering.motors.begin(), steering.motors.end(), is_set);
}

} // namespace

template<class Exec, class Real>
Visits<Exec, Real>::Visits(const Communicator& communicator, Log& log, const world::World& world,
                           const solver::Plan& plan, const Visitor& visitor, TimeLoop<Exec, Real>& loop)
    : communicator_(communicator)
    , log_(log)
    , world_(world)
    , plan_(plan)
    , visitor_(visitor)
    , loop_(loop)
    , phase_(loop.scene.phases.size())
    , bound_(solver::motion_bounds(loop.scene, world).acceleration)
{
}

template<class Exec, class Real>
bool Visits<Exec, Real>::is_due() const
{
    if (!visitor_.visit || !loop_.simulation.measured()) { return false; }
    const RunProgress& progress = loop_.progress;
    return phase_ != loop_.phase.index || multiples(progress.time, visitor_.every) > spans_ ||
           (visitor_.every_steps > 0 && progress.steps - last_step_ >= visitor_.every_steps);
}

template<class Exec, class Real>
std::optional<std::string> Visits<Exec, Real>::visit_if_due()
{
    if (!is_due()) { return {}; }
    if (phase_ != loop_.phase.index) { steering_.bodies.assign(loop_.scene.bodies.size(), {}); }
    steering_.motors.assign(loop_.scene.joints.size(), {});
    std::optional<std::string> stop = visit();
    phase_                          = loop_.phase.index;
    spans_                          = multiples(loop_.progress.time, visitor_.every);
    last_step_                      = loop_.progress.steps;
    if (!stop) { apply(); }
    return stop;
}

template<class Exec, class Real>
void Visits<Exec, Real>::visit_last()
{
    if (visitor_.visit) { visit(); }
}

/// Calls the visitor; returns the reason of the first rank that wants to stop.
template<class Exec, class Real>
std::optional<std::string> Visits<Exec, Real>::visit()
{
    const std::unique_ptr<VisitedArrays<Exec, Real>, DeleteUnlessKept> arrays(
        new VisitedArrays<Exec, Real>(loop_.simulation, plan_, loop_.progress.last_dt > 0), DeleteUnlessKept{visitor_});
    Present<Exec, Real>        present(world_, loop_, *arrays, steering_, impulses_);
    std::optional<std::string> stop = visitor_.visit(present);
    if (communicator_.size() == 1) { return stop; }
    const std::vector<std::int64_t> stops = communicator_.gather(static_cast<std::int64_t>(stop ? 1 : 0));
    const auto                      first = std::find(stops.begin(), stops.end(), 1);
    if (first == stops.end()) { return {}; }
    return communicator_.broadcast(stop.value_or(""), static_cast<int>(first - stops.begin()));
}

/// Every rank steers as rank 0 has asked.
template<class Exec, class Real>
void Visits<Exec, Real>::agree()
{
    broadcast(communicator_, steering_.bodies);
    broadcast(communicator_, steering_.motors);
    if (was_steered_ || !any(steering_)) { return; }
    was_steered_ = true;
    log_.warning("the calling program steers bodies or motors: scene.toml alone does not repeat this run");
}

template<class Exec, class Real>
void Visits<Exec, Real>::apply()
{
    agree();
    auto& simulation = loop_.simulation;
    for (std::size_t b = 0; b < steering_.bodies.size(); ++b)
    {
        const auto& wish = steering_.bodies[b];
        if (wish && wish->has_effort()) { simulation.expect_acceleration(bound_ + acceleration_by(world_, b, *wish)); }
    }
    for (std::size_t j = 0; j < steering_.motors.size(); ++j)
    {
        const auto& wish = steering_.motors[j];
        if (!wish) { continue; }
        simulation.begin_phase(loop_.phase.index); // which sets all motors
        simulation.set_motor(j, wish->speed, wish->most_torque);
    }
}

template<class Exec, class Real>
void Visits<Exec, Real>::steer(std::vector<solver::BodyCommand>& commands) const
{
    if (phase_ != loop_.phase.index) { return; }
    for (std::size_t b = 0; b < commands.size(); ++b)
    {
        if (steering_.bodies[b]) { run::steer(commands[b], *steering_.bodies[b]); }
    }
}

#define TREAD_INSTANTIATE(Exec, Real) template class Visits<Exec, Real>
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::run
