#include "solver/bodies/dem_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "backend/instantiate.hpp"
#include "kernels/dem/contact/body_contact.hpp"
#include "kernels/dem/contact/contact_limits.hpp"
#include "kernels/dem/motion/substeps.hpp"
#include "scene/phase_settings.hpp"
#include "solver/bodies/body_checks.hpp"
#include "solver/bodies/contact_records.hpp"
#include "solver/bodies/motion_bounds.hpp"
#include "solver/ranks/over_ranks.hpp"
#include "solver/state_file.hpp"
#include "world/materials.hpp"

namespace tread::solver
{

template<class Exec>
DemSolver<Exec>::DemSolver(const Exec& exec, const scene::Scene& scene, const world::World& world, const Plan& plan,
                           decomp::Decomposition<Exec>* decomposition)
    : state_(exec, scene, world, plan, decomposition)
    , commands_(world.bodies.named)
    , lists_(exec)
    , reports_(exec, total_rows(state_))
    , means_(exec, world.bodies.named)
    , prescribed_acceleration_(motion_bounds(scene, world).acceleration)
{
    if (plan.motions) { motions_.emplace(exec, world.bodies.named); }
    if (!world.joints.empty()) { joints_.emplace(exec, scene, world); }
    restore_contacts(state_);
    if (plan.rock_sleep) { begin_sleep(state_); }
}

template<class Exec>
void DemSolver<Exec>::command(const std::vector<BodyCommand>& commands)
{
    const bool changed = apply_commands(state_, commands_, commands);
    if (motions_) { commands_.largest_speed = std::max(commands_.largest_speed, motions_->set(state_, commands)); }
    if (changed && lists_.listed) { state_.stage(); }
}

template<class Exec>
void DemSolver<Exec>::begin_phase(std::size_t phase)
{
    if (joints_) { commands_.largest_speed = std::max(commands_.largest_speed, joints_->begin_phase(phase)); }
}

template<class Exec>
void DemSolver<Exec>::set_motor(std::size_t joint, double speed, std::optional<double> most_torque)
{
    commands_.largest_speed = std::max(commands_.largest_speed, joints_->set_motor(joint, speed, most_torque));
}

template<class Exec>
double DemSolver<Exec>::expect_acceleration(double acceleration)
{
    const double before      = prescribed_acceleration_;
    prescribed_acceleration_ = std::max(before, acceleration);
    return prescribed_acceleration_ - before;
}

template<class Exec>
bool DemSolver<Exec>::set_mass_scaling(std::size_t phase)
{
    const double most = scene::mass_scaling_in(state_.scene, phase);
    return std::exchange(state_.mass_scaling.most, most) != most;
}

template<class Exec>
void DemSolver<Exec>::set_contacts(std::size_t phase)
{
    state_.tables.properties.assign(world::pair_properties(state_.scene, phase));
    wake_for_phase(state_, lists_, sleep_, phase);
}

template<class Exec>
double DemSolver<Exec>::take_commanded_speed()
{
    return largest_over_ranks(state_.communicator(), std::exchange(commands_.largest_speed, 0.0));
}

template<class Exec>
bool DemSolver<Exec>::find_pairs(double dt)
{
    update_sleep(state_, lists_, reports_, sleep_, substep_);
    state_.pairs.sleep.wakes = state_.pairs.sleep.wanted;
    const bool found         = renew_pairs(dt, UnheldRows::go);
    state_.pairs.sleep.wakes = false;
    return found;
}

/// Returns whether pairs were found anew.
template<class Exec>
bool DemSolver<Exec>::renew_pairs(double dt, UnheldRows unheld)
{
    const bool found = update_pairs(state_, lists_, dt, substeps_in(dt), unheld);
    nodes_evaluated_ = state_.tables.law.rays == nullptr;
    if (found && row_moves() != nullptr) { reports_.follow(*row_moves()); }
    return found;
}

template<class Exec>
void DemSolver<Exec>::list_moved(const dem::OutsideWrenches& outside)
{
    const bool in_sand = outside.run != nullptr;
    if (!state_.pairs.sleep.wanted || !(in_sand || moved_in_sand_)) { return; }
    moved_in_sand_ = in_sand;
    dem::list_moved_bodies(state_.exec, state_.pairs, state_.view(), outside);
}

template<class Exec>
double DemSolver<Exec>::shortest_contact()
{
    return smallest_over_ranks(state_.communicator(), dem::smallest_contact_time(state_.exec, state_.pairs,
                                                                                 state_.view(), state_.mass_scaling));
}

template<class Exec>
void DemSolver<Exec>::refuse_substeps(const TimeStep& step, const Pace& pace, double time)
{
    solver::refuse_substeps(state_, step, pace, time);
}

template<class Exec>
std::int64_t DemSolver<Exec>::steps_without_check(double dt, double speed) const
{
    return solver::steps_without_check(state_, dt, bound(speed));
}

template<class Exec>
void DemSolver<Exec>::begin_substeps(const TimeStep& step, double speed, double contact_time)
{
    solver::begin_substeps(state_, lists_, step, bound(speed), contact_time);
}

/// The list is built for a whole step, so that it may serve the next. Nobody wakes within a step: the substep was
/// chosen for those that are awake.
template<class Exec>
bool DemSolver<Exec>::find_pairs_if_displaced(const TimeStep& step, std::int64_t done, double time)
{
    if (!std::exchange(lists_.expired, false)) { return false; }
    const double dt = step.dt / static_cast<double>(step.substeps);
    check_before_search(state_, reports_, time + dt * static_cast<double>(done));
    return renew_pairs(step.dt, UnheldRows::stay);
}

template<class Exec>
void DemSolver<Exec>::contact(double dt)
{
    const Exec exec = substep_exec();
    if (!nodes_evaluated_) { dem::evaluate_nodes(exec, state_.pairs, state_.view(), state_.tables.law); }
    dem::answer_contacts(exec, state_.pairs, state_.view(), state_.tables.law, dt);
}

template<class Exec>
void DemSolver<Exec>::move(double dt, double damping, const dem::OutsideWrenches& outside)
{
    dem::BodyStep<Exec> step = body_step(dt, damping);
    step.motion.outside      = outside;
    step.limit.repeated      = nullptr;
    if (shares())
    {
        dem::share_wrenches(substep_exec(), step);
        state_.ranks->shared().exchange_wrenches();
    }
    dem::move_bodies(substep_exec(), step);
    requested(1);
}

template<class Exec>
void DemSolver<Exec>::run(double dt, double damping, std::int64_t count)
{
    if (shares())
    {
        for (std::int64_t substep = 0; substep < count; ++substep)
        {
            contact(dt);
            move(dt, damping);
        }
        return;
    }
    dem::run_substeps(substep_exec(), body_step(dt, damping), count);
    requested(count);
}

template<class Exec>
Exec DemSolver<Exec>::substep_exec()
{
    Exec                         exec  = state_.exec;
    const dem::DisplacementLimit limit = lists_.limit(state_);
    exec.number                        = {limit.last, limit.substep};
    return exec;
}

template<class Exec>
dem::BodyStep<Exec> DemSolver<Exec>::body_step(double dt, double damping)
{
    dem::Motion motion{state_.gravity, damping, dt};
    if (state_.scales_inertia)
    {
        constexpr double any = std::numeric_limits<double>::infinity();
        motion.scaling       = {state_.inertia_factor.data(),
                          state_.mass_scaling.most > 1 ? std::pow(state_.scene.time.contact_share / dt, 2) : any};
    }
    return {state_.pairs,
            state_.view(),
            state_.tables.law,
            reports_.totals.data(),
            means_.view(),
            motion,
            state_.shared(),
            motions_ ? motions_->view() : dem::PrescribedView{},
            joints_ ? joints_->view() : dem::JointsView{},
            lists_.limit(state_)};
}

template<class Exec>
std::int64_t DemSolver<Exec>::take_done(double dt)
{
    const std::int64_t done = lists_.take_done(state_.exec);
    means_.time += static_cast<double>(done) * dt;
    state_.pairs.sleep.pass(static_cast<double>(done) * dt);
    substep_ = dt;
    return done;
}

template<class Exec>
void DemSolver<Exec>::request_report()
{
    solver::request_report(state_, reports_, lists_);
}

template<class Exec>
RigidReport DemSolver<Exec>::report(double time)
{
    if (!reports_.activity) { request_report(); }
    RigidReport report = take_report(state_, reports_, lists_, {time, substep_, commands_.take_totals()});
    if (joints_) { joints_->check(time); }
    report.driver_impulse -= std::exchange(state_.pairs.sleep.clock.weight, 0.0) * state_.gravity;
    return report;
}

template<class Exec>
RigidCensus DemSolver<Exec>::census()
{
    return body_census(state_, reports_.totals);
}

template<class Exec>
std::vector<BodyRow> DemSolver<Exec>::named_bodies()
{
    std::vector<BodyRow> rows = named_rows(state_, means_);
    if (!motions_) { return rows; }
    const auto reactions = motions_->mean_reactions(state_, means_.time);
    for (std::size_t b = 0; b < rows.size(); ++b)
    {
        rows[b].reaction_force  = reactions[b].linear;
        rows[b].reaction_torque = reactions[b].angular;
    }
    return rows;
}

template<class Exec>
std::vector<JointRow> DemSolver<Exec>::joints() const
{
    return joints_ ? joints_->rows(means_.time) : std::vector<JointRow>{};
}

template<class Exec>
void DemSolver<Exec>::begin_mean()
{
    solver::begin_mean(state_, means_);
    if (motions_) { motions_->begin_mean(); }
    if (joints_) { joints_->begin_mean(); }
}

template<class Exec>
io::BodyFields DemSolver<Exec>::fields() const
{
    return body_fields(state_);
}

template<class Exec>
std::vector<world::ContactRecord> DemSolver<Exec>::contacts() const
{
    return live_contacts(state_);
}

template<class Exec>
ContactCount DemSolver<Exec>::count_contacts()
{
    const std::vector<double> stiffness = state_.pairs.answers.stiffness.to_host();
    const auto live = std::count_if(stiffness.begin(), stiffness.end(), [](double value) { return value > 0; });
    return {static_cast<double>(stiffness.size()), static_cast<double>(live),
            static_cast<double>(state_.pairs.nodes.node.size())};
}

template<class Exec>
Vec3<double> DemSolver<Exec>::place(std::size_t body) const
{
    return body_place(state_, body);
}

template<class Exec>
double DemSolver<Exec>::carried(std::size_t body) const
{
    return solver::carried(state_, means_, body);
}

template<class Exec>
Vec3<double> DemSolver<Exec>::contact_impulse(std::size_t body) const
{
    return solver::contact_impulse(state_, means_, body);
}

/// The single numbers of all parts are one row, bodies/steps.
template<class Exec>
void DemSolver<Exec>::transfer(StateFile& file)
{
    state_.transfer(file);
    file.numbers("bodies/steps", lists_.version, lists_.checked_within_step, commands_.largest_speed,
                 reports_.rebuilt_overlap, means_.time, substep_, commands_.totals.work);
    commands_.transfer(file);
    means_.transfer(file);
    if (motions_) { motions_->transfer(file); }
    transfer_contacts(state_, file);
    lists_.transfer(file, state_);
    reports_.transfer(file, total_rows(state_));
    if (joints_) { joints_->transfer(file); }
    if (state_.pairs.sleep.wanted) { transfer_sleep(state_, sleep_, file); }
}

#define TREAD_INSTANTIATE(Exec) template class DemSolver<Exec>
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
