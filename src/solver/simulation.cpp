#include "solver/simulation.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "backend/instantiate.hpp"
#include "solver/ledger/contact_guards.hpp"
#include "solver/pace_limits.hpp"
#include "solver/ranks/page_owners.hpp"
#include "solver/state_file.hpp"
#include "world/terrain_bins.hpp"

namespace tread::solver
{
namespace
{

Vec3<double> vector(const scene::Vector3& v) { return {v[0], v[1], v[2]}; }

double free_mass(const world::World& world)
{
    const double sand  = world::total_mass(world.sand);
    const double rocks = std::accumulate(world.bodies.mass.begin() + world.bodies.named, world.bodies.mass.end(), 0.0);
    return sand + rocks;
}

/// m/s, of sand; bodies get theirs by command.
double speed_at_start(const scene::Scene& scene)
{
    double speed = 0;
    for (const scene::Terrain& terrain : scene.terrain) { speed = std::max(speed, vector(terrain.velocity).norm()); }
    return speed;
}

/// Throws if the plan leaves out what bodies need on several ranks.
void require_plan_of_ranks(const Plan& plan)
{
    if (plan.bodies && !plan.body_contact)
    {
        throw std::logic_error("the plan of a simulation on several ranks was made for one");
    }
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
    , free_mass_(free_mass(world))
    , gravity_(vector(scene.domain.gravity))
{
    if (decomposition != nullptr) { require_plan_of_ranks(plan); }
    measuring_.pace.largest_speed = measuring_.pace.sand_speed = speed_at_start(scene);
    if (decomposition != nullptr) { balance_.emplace(*decomposition, scene.balance); }
    if (plan.sand)
    {
        sand_.emplace(exec, scene, world,
                      mpm::PointFields{plan.affine, plan.plasticity, plan.coupling, plan.cap, plan.nonlocal},
                      decomposition);
    }
    if (plan.bodies) { rigid_.emplace(exec, scene, world, plan, decomposition); }
    if (plan.coupling)
    {
        coupling_.emplace(exec, scene, world, rigid_->templates(), rigid_->pair_table(), decomposition);
    }
}

template<class Exec, class Real>
void Simulation<Exec, Real>::begin()
{
    if (plan_.body_contact)
    {
        rigid_->find_pairs(choose_step(scene_.time, limits_, measuring_.pace, 0).dt);
        if (!world_.contacts.empty()) { rigid_->contact(0); } // the ledger starts with the contacts' energy
        measuring_.pace.shortest_contact = rigid_->shortest_contact();
    }
    const Census start = census();
    ledger_.emplace(gravity_, start);
    if (sand_) { guard_.emplace(limits_, start.sand.mass); }
}

template<class Exec, class Real>
void Simulation<Exec, Real>::command(const std::vector<BodyCommand>& commands, double damping)
{
    damping_ = damping;
    if (!rigid_) { return; }
    rigid_->command(commands);
    rigid_->set_damping(damping);
}

/// Preconditions: command() has set the commands of the named bodies. If measured(), `step` was chosen from pace()
/// by choose_step; else it is the last step, or one of another length, before which it measures. Contact lists of the
/// last step were made for the present layout_version().
template<class Exec, class Real>
TimeStep Simulation<Exec, Real>::step(TimeStep step, double time, StageClock& clock)
{
    if (!ledger_) { throw std::logic_error("the simulation has not begun"); }
    // 1. Commands, the Courant number; points and bodies go to their ranks, points are listed.
    apply_commands(step);
    measure_before_change(step.dt);
    if (guard_) { guard_->allow(step, time); }
    sort_and_migrate(clock);
    // 2. Sleep.
    update_sleeping_pages(clock);
    // 3. Contact lists; number of substeps.
    find_contacts(step, time, clock);
    // 4. Contact substeps: bodies move, sand gets the contact forces.
    move_bodies(step, time, clock);
    // 5. and 6. P2G, grid, G2P.
    if (sand_) { move_sand(step.dt, clock); }
    // 7. Measurements.
    measure_if_due(step, time, clock);
    return step;
}

/// If a command makes a body faster than the largest speed measured, contact lists are valid for this step only, and
/// the step is shortened to its limits.
template<class Exec, class Real>
void Simulation<Exec, Real>::apply_commands(TimeStep& step)
{
    if (!rigid_) { return; }
    const double commanded = rigid_->take_commanded_speed();
    if (commanded <= measuring_.pace.largest_speed) { return; }
    if (!measured()) { measure(); }
    measuring_.pace.largest_speed = std::max(measuring_.pace.largest_speed, commanded);
    measuring_.every              = 1;
    const TimeStep wanted         = choose_step(scene_.time, limits_, measuring_.pace, 0);
    if (wanted.dt < step.dt && !scene_.time.dt) { step = wanted; }
}

/// The ledger accounts for steps of one length together.
template<class Exec, class Real>
void Simulation<Exec, Real>::measure_before_change(double dt)
{
    if (!measured() && dt != last_.step.dt) { measure(); }
}

/// Lists points; on several ranks, migrates points and their contact records to the owners of their pages. Bodies
/// migrate when their pairs are found next.
template<class Exec, class Real>
void Simulation<Exec, Real>::sort_and_migrate(StageClock& clock)
{
    if (!sand_ && !balance_) { return; }
    clock.run(exec_, stage::order, [&] { list_points(); });
}

template<class Exec, class Real>
void Simulation<Exec, Real>::list_points()
{
    if (balance_ && measured() && balance_->is_due()) { repartition_pages(); }
    if (sand_) { sand_->order(); }
    send_records();
    if (!balance_ || balance_->has_noted(layout_version())) { return; }
    const double points = sand_ ? static_cast<double>(sand_->view().count) : 0, bodies = rigid_ ? rigid_->load() : 0;
    balance_->note(layout_version(), points + bodies, sand_ ? sand_->migrated() : 0);
}

/// Sends the contact records of the points that migrated when points were last sorted.
template<class Exec, class Real>
void Simulation<Exec, Real>::send_records()
{
    if (coupling_ && sand_->migrated() > 0) { coupling_->send_records_after(sand_->migrated_out()); }
}

template<class Exec, class Real>
decomp::PageLoads Simulation<Exec, Real>::page_loads() const
{
    decomp::PageLoads loads;
    if (sand_) { sand_->add_loads(loads); }
    if (rigid_) { rigid_->add_loads(loads); }
    return loads;
}

template<class Exec, class Real>
void Simulation<Exec, Real>::repartition_pages()
{
    if (balance_->repartition(page_loads()) && sand_) { follow_owners(); }
}

/// Serves a state from another number of ranks: the present owners of pages were chosen for the scene's start.
template<class Exec, class Real>
void Simulation<Exec, Real>::repartition_loaded()
{
    balance_->repartition_anew(page_loads());
    if (sand_) { sand_->follow_owners(); }
}

/// Contact lists stay valid until the next measurement; the number of substeps follows from the contacts listed.
template<class Exec, class Real>
void Simulation<Exec, Real>::find_contacts(TimeStep& step, double time, StageClock& clock)
{
    if (measured()) { list_contacts(step.dt * static_cast<double>(measuring_.every), clock); }
    require_apart(time);
    if (plan_.body_contact) { step.substeps = substeps_of(scene_.time, step.dt, limits_, measuring_.pace); }
    if (step.substeps > scene::most_substeps) { rigid_->refuse_substeps(step, measuring_.pace, time); }
}

/// Builds contact lists that are valid for steps of `span` (s) in all.
template<class Exec, class Real>
void Simulation<Exec, Real>::list_contacts(double span, StageClock& clock)
{
    if (plan_.body_contact)
    {
        const auto find = [&]
        {
            if (rigid_->find_pairs(span) && coupling_) { follow_sleepers(*rigid_, *coupling_); }
        };
        clock.run(exec_, stage::pairs, find);
        measuring_.pace.shortest_contact = rigid_->shortest_contact();
        wake_sand_near_rocks(clock);
    }
    if (!coupling_) { return; }
    const auto find = [&]
    {
        coupling_->find_candidates(sand_->view(), sand_->pages(), rigid_->view(),
                                   {rigid_->list_version(), rigid_->listed()}, layout_version(),
                                   {span, measuring_.pace.largest_speed, measuring_.pace.sand_speed});
    };
    clock.run(exec_, stage::candidates, find);
}

template<class Exec, class Real>
void Simulation<Exec, Real>::move_bodies(const TimeStep& step, double time, StageClock& clock)
{
    if (!rigid_) { return; }
    loaded_energies_.reset();
    if (coupling_)
    {
        clock.run(exec_, stage::candidates, [&] { coupling_->begin_step(sand_->view()); });
    }
    run_substeps<Exec, Real>({exec_, plan_, *rigid_, coupling_ ? &*coupling_ : nullptr, damping_, why_stop_}, step,
                             time, measuring_.pace, clock);
    if (coupling_)
    {
        clock.run(exec_, stage::sand_contact, [&] { coupling_->finish_step(sand_->view(), step.dt); });
    }
}

template<class Exec, class Real>
void Simulation<Exec, Real>::move_sand(double dt, StageClock& clock)
{
    clock.run(exec_, stage::scatter, [&] { sand_->scatter(); });
    if (decomposition_ != nullptr)
    {
        clock.run(exec_, stage::halo, [&] { sand_->share(); });
    }
    clock.run(exec_, stage::grid, [&] { sand_->update_grid(dt, damping_); });
    clock.run(exec_, stage::gather, [&] { sand_->gather(dt); });
}

template<class Exec, class Real>
void Simulation<Exec, Real>::measure_if_due(const TimeStep& step, double time, StageClock& clock)
{
    last_ = {step, time};
    if (balance_) { balance_->pass(); }
    if (++measuring_.unmeasured < measuring_.every) { return; }
    clock.run(exec_, stage::measure, [&] { measure(); });
}

template<class Exec, class Real>
void Simulation<Exec, Real>::measure()
{
    Pace&              pace  = measuring_.pace;
    const std::int64_t steps = std::exchange(measuring_.unmeasured, 0);
    if (rigid_) { rigid_->request_report(); }
    if (coupling_) { coupling_->request_measure(); }
    const SandReport  sand  = sand_ ? sand_->report() : SandReport{};
    const RigidReport rigid = rigid_ ? rigid_->report(last_.time) : RigidReport{};
    if (guard_) { guard_->check(sand, last_.step, last_.time); }
    pace.sand_speed    = sand.largest_speed;
    pace.largest_speed = std::max(sand.largest_speed, rigid.largest_speed);
    pace.overlap       = rigid.overlap;
    if (scene_.time.substeps) { require_stable_substep(last_, pace); }
    const ContactReport contacts = coupling_ ? measure_contacts() : ContactReport{};
    measuring_.extremes.note(last_.step, steps, limits_, pace,
                             coupling_ ? coupling_->summary() : contact::Summary::zero());
    const double weight   = free_mass_ * gravity_.norm();
    measuring_.unbalanced = weight > 0 ? (sand.last_grid[mpm::grid_net_force] + rigid.net_force) / weight : 0;
    ledger_->steps(last_.step.dt, steps, sand, rigid, contacts, moving_mass());
    if (guard_) { guard_->watch(sand, last_.step, last_.time); }
    measuring_.every = steps_to_measure();
}

template<class Exec, class Real>
ContactReport Simulation<Exec, Real>::measure_contacts()
{
    coupling_->measure();
    const contact::Summary& contacts = coupling_->summary();
    measuring_.pace.stiffest_point   = contacts.stiffest.value;
    require_unique_surface(
        contacts, [this](std::int64_t body) { return rigid_->name(body); }, last_.time);
    return {contacts.dissipated + coupling_->take_loss_at_rest(), coupling_->energy()};
}

/// Number of steps until the next measurement, for which the pair list must also need no check.
template<class Exec, class Real>
std::int64_t Simulation<Exec, Real>::steps_to_measure() const
{
    if (!sand_) { return 1; }
    const Pace&        pace  = measuring_.pace;
    const std::int64_t steps = steps_until_measured(last_.step, limits_, pace, scene_.grid.finest());
    if (!rigid_) { return steps; }
    return std::min(steps, rigid_->steps_without_check(last_.step.dt, pace.largest_speed));
}

template<class Exec, class Real>
Census Simulation<Exec, Real>::census()
{
    if (!measured()) { measure(); }
    list_points();
    Census now;
    if (sand_) { now.sand = sand_->census(); }
    if (rigid_) { now.rigid = rigid_->census(); }
    if (coupling_) { now.sand_contact = coupling_->energy(); }
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
    if (rigid_) { rigid_->add_rocks(bins); }
    if (decomposition_ != nullptr) { bins.add_ranks(decomposition_->communicator); }
    return bins.surface();
}

/// Bodies come in the order of a step: contact needs the positions of points and bodies.
template<class Exec, class Real>
void Simulation<Exec, Real>::transfer(StateFile& file)
{
    if (decomposition_ != nullptr && file.exact()) { transfer_page_owners(file, *decomposition_); }
    if (balance_ && file.exact()) { balance_->transfer(file); }
    if (sand_) { sand_->transfer(file, world_.sand); }
    if (rigid_) { rigid_->transfer(file); }
    if (coupling_)
    {
        const ContactPartners partners{world_.bodies.size(), static_cast<std::size_t>(sand_->view().count),
                                       world_.sand.size(), scene_.materials.size()};
        coupling_->transfer(file, rigid_->view(), partners);
        if (rigid_->sleepers().strewn)
        {
            coupling_->transfer_sleep(file, rigid_->view(), rigid_->sleepers(), partners);
        }
    }
    transfer_contacts(file);
    solver::transfer(file, measuring_, last_, damping_);
    ledger_->transfer(file);
    if (file.loads()) { set_gravity(ledger_->gravity()); }
    if (guard_) { guard_->transfer(file); }
    if (balance_ && file.loads() && !file.exact()) { repartition_loaded(); }
}

#define TREAD_INSTANTIATE(Exec, Real) template class Simulation<Exec, Real>
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
