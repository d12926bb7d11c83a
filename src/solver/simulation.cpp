#include "solver/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "backend/instantiate.hpp"
#include "base/errors.hpp"
#include "solver/body_reaches.hpp"
#include "solver/pace_limits.hpp"
#include "world/terrain_bins.hpp"

namespace tread::solver
{
namespace
{

constexpr double longest_substep =
    0.8; ///< dt/N over sqrt(m / sum K): beyond it a contact gains energy (docs/theory.md#time-step)
constexpr double unseen_travel  = 0.5; ///< displacement of sand, in spacings, after which it is measured again
constexpr double least_gradient = 0.5; ///< |grad phi| in contact below which a point is past the medial axis

Vec3<double> vector(const scene::Vector3& v) { return {v[0], v[1], v[2]}; }

double free_weight(const scene::Scene& scene, const world::World& world)
{
    const double sand  = std::accumulate(world.points.mass.begin(), world.points.mass.end(), 0.0);
    const double rocks = std::accumulate(world.bodies.mass.begin() + world.bodies.named, world.bodies.mass.end(), 0.0);
    return (sand + rocks) * vector(scene.domain.gravity).norm();
}

/// m/s, of sand; bodies get theirs by command.
double speed_at_start(const scene::Scene& scene)
{
    double speed = 0;
    for (const scene::Terrain& terrain : scene.terrain) { speed = std::max(speed, vector(terrain.velocity).norm()); }
    return speed;
}

} // namespace

template<class Exec, class Real>
Simulation<Exec, Real>::Simulation(const Exec& exec, const scene::Scene& scene, const world::World& world,
                                   const Plan& plan, decomp::Decomposition<Exec>* decomposition)
    : exec_(exec)
    , decomposition_(decomposition)
    , scene_(scene)
    , world_(world)
    , plan_(plan)
    , limits_(pace_limits(scene, world, plan))
    , gravity_(vector(scene.domain.gravity))
    , weight_(free_weight(scene, world))
{
    pace_.largest_speed = speed_at_start(scene);
    if (decomposition != nullptr) { balance_.emplace(*decomposition, scene.balance.threshold); }
    if (plan.sand)
    {
        sand_.emplace(exec, scene, world, mpm::PointFields{plan.affine, plan.plasticity, plan.coupling}, decomposition);
    }
    plan_.body_contact =
        plan.body_contact || (plan.bodies && decomposition != nullptr); // the list decides who holds which body
    if (plan.bodies) { rigid_.emplace(exec, scene, world, plan_, decomposition); }
    if (plan.coupling)
    {
        coupling_.emplace(exec, scene, world, rigid_->templates(), rigid_->pair_table(), decomposition);
    }
    if (plan_.body_contact)
    {
        rigid_->find_pairs(choose_step(scene.time, limits_, pace_, 0).dt);
        if (!world.contacts.empty()) { rigid_->contact(0); } // the ledger starts with the contacts' energy
        pace_.shortest_contact = rigid_->shortest_contact();
    }
    const Census start = census();
    ledger_.emplace(gravity_, start);
    if (sand_) { guard_.emplace(limits_, start.sand.mass); }
}

template<class Exec, class Real>
void Simulation<Exec, Real>::command(const std::vector<BodyCommand>& commands, double damping)
{
    damping_ = damping;
    if (rigid_) { rigid_->command(commands); }
}

template<class Exec, class Real>
TimeStep Simulation<Exec, Real>::step(TimeStep step, double time, StageClock& clock)
{
    if (rigid_) { apply_commands(step); }
    if (unmeasured_ > 0 && step.dt != last_.dt) { measure(); } // the ledger accounts for steps of one length together
    if (sand_) { guard_->allow(step, time); }
    if (sand_ || balance_)
    {
        clock.run(exec_, stage::order, [&] { sort_and_migrate(); });
    }
    if (sand_ && unmeasured_ == 0 && sand_->sleep_is_due(pace_.largest_speed, damping_))
    {
        clock.run(exec_, stage::sleep, [&] { update_sleeping_pages(); });
    }
    if (unmeasured_ == 0) { find_contacts(step, clock); }
    if (plan_.body_contact) { step.substeps = substeps_of(scene_.time, step.dt, limits_, pace_); }
    if (step.substeps > scene::most_substeps) { rigid_->refuse_substeps(step, pace_, time); }
    if (coupling_)
    {
        clock.run(exec_, stage::candidates, [&] { coupling_->begin_step(sand_->view()); });
    }
    if (rigid_) { substeps(step, time, clock); }
    if (coupling_)
    {
        clock.run(exec_, stage::sand_contact, [&] { coupling_->finish_step(sand_->view(), step.dt); });
    }
    if (sand_)
    {
        clock.run(exec_, stage::scatter, [&] { sand_->scatter(); });
        if (decomposition_ != nullptr)
        {
            clock.run(exec_, stage::halo, [&] { sand_->share(); });
        }
        clock.run(exec_, stage::grid, [&] { sand_->update_grid(step.dt, damping_); });
        clock.run(exec_, stage::gather, [&] { sand_->gather(step.dt); });
    }
    last_      = step;
    last_time_ = time;
    ++steps_;
    if (++unmeasured_ >= measure_every_)
    {
        clock.run(exec_, stage::measure, [&] { measure(); });
    }
    return step;
}

/// Lists points; on several ranks, migrates points and their contact records to the owners of their pages. Bodies
/// migrate when their pairs are found next.
template<class Exec, class Real>
void Simulation<Exec, Real>::sort_and_migrate()
{
    if (balance_ && unmeasured_ == 0 && balance_->is_due(steps_)) { repartition_pages(); }
    if (sand_) { sand_->order(); }
    const std::int64_t moved = sand_ ? sand_->migrated() : 0;
    if (coupling_ && moved > 0) { coupling_->send_records_after(sand_->migrated_out()); }
    if (!balance_ || layout_version() == balanced_version_) { return; }
    balanced_version_   = layout_version();
    const double points = sand_ ? static_cast<double>(sand_->count()) : 0, bodies = rigid_ ? rigid_->load() : 0;
    balance_->note(points + bodies, moved);
}

template<class Exec, class Real>
void Simulation<Exec, Real>::repartition_pages()
{
    decomp::PageLoads loads;
    if (sand_) { sand_->add_loads(loads); }
    if (rigid_) { rigid_->add_loads(loads); }
    if (balance_->repartition(loads, steps_) && sand_) { sand_->follow_owners(); }
}

template<class Exec, class Real>
void Simulation<Exec, Real>::update_sleeping_pages()
{
    std::vector<BodyReach> bodies;
    if (rigid_) { bodies = body_reaches(exec_, rigid_->view(), world_); }
    sand_->update_sleeping_pages(bodies, damping_);
}

/// If a command makes a body faster than the largest speed measured, contact lists are valid for this step only, and
/// the step is shortened to its limits.
template<class Exec, class Real>
void Simulation<Exec, Real>::apply_commands(TimeStep& step)
{
    const double commanded = rigid_->take_commanded_speed();
    if (commanded <= pace_.largest_speed) { return; }
    if (unmeasured_ > 0) { measure(); }
    pace_.largest_speed   = std::max(pace_.largest_speed, commanded);
    measure_every_        = 1;
    const TimeStep wanted = choose_step(scene_.time, limits_, pace_, 0);
    if (wanted.dt < step.dt && !scene_.time.dt) { step = wanted; }
}

/// Builds contact lists that stay valid for the next `measure_every_` steps.
template<class Exec, class Real>
void Simulation<Exec, Real>::find_contacts(const TimeStep& step, StageClock& clock)
{
    const double span = step.dt * static_cast<double>(measure_every_);
    if (plan_.body_contact)
    {
        clock.run(exec_, stage::pairs, [&] { rigid_->find_pairs(span); });
        pace_.shortest_contact = rigid_->shortest_contact();
    }
    if (coupling_)
    {
        clock.run(exec_, stage::candidates,
                  [&]
                  {
                      coupling_->find_candidates(sand_->view(), sand_->pages(), rigid_->view(), layout_version(), span,
                                                 pace_.largest_speed);
                  });
    }
}

/// Chooses the number of steps until the next measurement: no point may move more than half a cell, and the pair list
/// must need no check. A step over its limits is measured every time.
template<class Exec, class Real>
void Simulation<Exec, Real>::choose_measuring()
{
    measure_every_ = 1;
    if (!sand_ || over_limit(last_, limits_, pace_)) { return; }
    const double travel = pace_.largest_speed * last_.dt;
    measure_every_      = static_cast<std::int64_t>(
        std::clamp(unseen_travel * scene_.grid.finest() / travel, 1.0, static_cast<double>(most_unmeasured)));
    if (rigid_)
    {
        measure_every_ = std::min(measure_every_, rigid_->steps_without_check(last_.dt, pace_.largest_speed));
    }
}

template<class Exec, class Real>
void Simulation<Exec, Real>::measure()
{
    const TimeStep&    step  = last_;
    const double       time  = last_time_;
    const std::int64_t steps = std::exchange(unmeasured_, 0);
    if (rigid_) { rigid_->request_report(); }
    if (coupling_) { coupling_->request_measure(); }
    const SandReport  sand  = sand_ ? sand_->report() : SandReport{};
    const RigidReport rigid = rigid_ ? rigid_->report(time) : RigidReport{};
    if (guard_) { guard_->check(sand, step, time); }
    pace_.largest_speed  = std::max(sand.largest_speed, rigid.largest_speed);
    pace_.overlap        = rigid.overlap;
    const double substep = step.dt / static_cast<double>(step.substeps);
    if (scene_.time.substeps && pace_.shortest_contact > 0 && substep > longest_substep * pace_.shortest_contact)
    {
        throw NumericalError(
            fmt::format("t = {:.6g} s: a substep of {:.4g} s is {:.3g} of a body's sqrt(m / sum K), over the "
                        "{} at which its contacts gain energy: more substeps, or a smaller dt",
                        time, substep, substep / pace_.shortest_contact, longest_substep));
    }
    ContactReport losses;
    if (coupling_)
    {
        coupling_->measure();
        const contact::Summary& contacts = coupling_->summary();
        pace_.stiffest_point             = contacts.stiffest.value;
        losses                           = {contacts.dissipated, contacts.energy};
        if (contacts.live > 0 && contacts.flattest.value < least_gradient)
        {
            throw NumericalError(fmt::format("t = {:.6g} s: point {} is so deep in body {} that its nearest surface is "
                                             "not unique (|grad phi| = {:.2g}, "
                                             "least {}): a smaller dt, or a finer grid beside thin walls",
                                             time, contacts.flattest.point_id, rigid_->name(contacts.flattest.body),
                                             contacts.flattest.value, least_gradient));
        }
    }
    extremes_.note(step, steps, limits_, pace_, coupling_ ? coupling_->summary() : contact::Summary::zero());
    unbalanced_ = weight_ > 0 ? (sand.last_grid[mpm::grid_net_force] + rigid.net_force) / weight_ : 0;
    ledger_->steps(step.dt, steps, sand, rigid, losses, (sand_ ? sand_->mass() : 0) + (rigid_ ? rigid_->mass() : 0));
    if (guard_) { guard_->watch(sand, step, time); }
    choose_measuring();
}

template<class Exec, class Real>
Census Simulation<Exec, Real>::census()
{
    if (unmeasured_ > 0) { measure(); }
    sort_and_migrate();
    Census now;
    if (sand_) { now.sand = sand_->census(); }
    if (rigid_) { now.rigid = rigid_->census(); }
    if (coupling_) { now.sand_contact = coupling_->summary().energy; }
    return now;
}

template<class Exec, class Real>
std::vector<BodyRow> Simulation<Exec, Real>::named_bodies()
{
    return rigid_ ? rigid_->named_bodies() : std::vector<BodyRow>{};
}

template<class Exec, class Real>
void Simulation<Exec, Real>::begin_mean()
{
    if (rigid_) { rigid_->begin_mean(); }
}

template<class Exec, class Real>
void Simulation<Exec, Real>::copy_points(PointCopy<Exec, Real>& copy) const
{
    if (sand_) { sand_->copy_to(copy); }
}

template<class Exec, class Real>
io::PointFields Simulation<Exec, Real>::point_fields() const
{
    PointCopy<Exec, Real> copy(exec_);
    copy_points(copy);
    return copy.rows();
}

template<class Exec, class Real>
std::vector<world::ContactRecord> Simulation<Exec, Real>::contacts()
{
    return rigid_ ? rigid_->contacts() : std::vector<world::ContactRecord>{};
}

template<class Exec, class Real>
io::BodyFields Simulation<Exec, Real>::body_fields()
{
    return rigid_ ? rigid_->fields() : io::BodyFields{};
}

template<class Exec, class Real>
std::vector<double> Simulation<Exec, Real>::surface_heights(const world::ColumnLattice& lattice)
{
    world::TerrainBins bins(lattice);
    if (sand_) { sand_->add_to(bins); }
    if (decomposition_ != nullptr) { bins.add_ranks(decomposition_->communicator); }
    if (plan_.rocks)
    {
        const std::vector<double> place = body_fields().position;
        for (auto b = static_cast<std::size_t>(world_.bodies.named); b < world_.bodies.size(); ++b)
        {
            bins.add_sphere(Vec3<double>(place.data() + 3 * b), world_.bodies.radius[b]);
        }
    }
    return bins.surface();
}

#define TREAD_INSTANTIATE(Exec, Real) template class Simulation<Exec, Real>
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
