#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "io/snapshot.hpp"
#include "solver/bodies/body_command.hpp"
#include "solver/bodies/body_row.hpp"
#include "solver/coupling/contact_substeps.hpp"
#include "solver/ledger/ledger.hpp"
#include "solver/ledger/measuring.hpp"
#include "solver/ledger/sand_guard.hpp"
#include "solver/ranks/work_balance.hpp"
#include "solver/sand/mpm_solver.hpp"
#include "solver/touch_change.hpp"

namespace tread::solver
{

class StateFile;

/// State of a scene on one backend, and one step of it. Parts that the plan leaves out are not constructed. With a
/// decomposition every call is collective, and results are the same on all ranks unless a comment says otherwise.
template<class Exec, class Real>
class Simulation
{
public:
    /// Builds the parts. `plan`: of a run on as many ranks; std::logic_error if it leaves out what several ranks need.
    /// `decomposition`: ownership of pages; null on one rank.
    Simulation(const Exec& exec, const scene::Scene& scene, const world::World& world, const Plan& plan,
               decomp::Decomposition<Exec>* decomposition = nullptr);

    /// Finds the pairs of bodies, and takes the census that the balances start from. Call once, before the first step
    /// or a checkpoint is loaded; the rocks of `world` may have been released (world::release_rocks).
    void begin();

    const Exec& exec() const { return exec_; }

    /// Bounds on the steps of this scene.
    const PaceLimits& limits() const { return limits_; }

    /// Values measured after the last step.
    const Pace& pace() const { return measuring_.pace; }

    /// Unbalanced force over weight in the last measured step.
    double unbalanced() const { return measuring_.unbalanced; }

    /// Worst values over all measured steps.
    const Extremes& extremes() const { return measuring_.extremes; }

    /// Distribution of work over the ranks so far; null on one rank.
    const decomp::BalanceRow* balance() const { return balance_ ? &balance_->row() : nullptr; }

    /// The scene must have sand.
    MpmSolver<Exec, Real>& sand() { return *sand_; }

    /// Call after pages have got other owners, with no step since the last census: sleeping points go to them at once,
    /// with their contacts, and awake ones when they are sorted next. Collective.
    void follow_owners();

    /// The scene must have bodies.
    DemSolver<Exec>& rigid() { return *rigid_; }

    /// Mean share of the points that have slept so far; empty where sleep is off.
    std::optional<double> mean_asleep() const { return sand_ ? sand_->mean_asleep() : std::nullopt; }

    /// Mean share of the rocks that have slept so far; empty where none may.
    std::optional<double> mean_rocks_asleep() const { return rigid_ ? rigid_->mean_asleep() : std::nullopt; }

    /// Number of rocks that sleep.
    std::int64_t rocks_asleep() const { return rigid_ ? rigid_->asleep() : 0; }

    /// Number of points of this rank.
    std::int64_t points() const { return sand_ ? sand_->count() : 0; }

    /// Sets the commands of the named bodies (held, driven, free) until the next call; `damping` is the phase's.
    void command(const std::vector<BodyCommand>& commands, double damping);

    /// Call before each step with the index of its phase: sets gravity, contacts, the scaling of inertia and
    /// motors to those of the phase.
    void begin_phase(std::size_t phase);

    /// Sets the speed (rad/s) and the largest torque (N m; empty: as before) of a joint's motor until the phase ends.
    /// Call after begin_phase.
    void set_motor(std::size_t joint, double speed, std::optional<double> most_torque)
    {
        rigid_->set_motor(joint, speed, most_torque);
    }

    /// Call when measured(), before commands whose forces the scene does not hold: `acceleration` (m/s2) bounds what
    /// they cause at any point of a body.
    void expect_acceleration(double acceleration);

    /// Sets a check that all ranks call together from time to time within a step of many substeps; if it returns a
    /// reason, the run stops there (StoppedInStep).
    void set_stop_check(StopCheck why) { why_stop_ = std::move(why); }

    /// Takes one MPM step of `step.dt`, or a shorter one where a command has made a body too fast for it, with its
    /// contact substeps (docs/theory.md#coupling). NumericalError, with cause, place and limit, when the state is no
    /// longer valid; `time` (s), at which the step begins, is for that message. When motion is slow, it measures every
    /// few steps only: pace() and unbalanced() are then as old as that, and contact lists and N are those of the first
    /// of these steps.
    TimeStep step(TimeStep step, double time, StageClock& clock);

    /// Whether pace() is of the last step; only then choose another dt.
    bool measured() const { return measuring_.unmeasured == 0; }

    /// Census of the present state; measures first.
    Census census();

    /// Rows of the named bodies; force and torque are means since the last begin_mean().
    std::vector<BodyRow> named_bodies();
    void                 begin_mean();

    /// Rows of the joints; force and torque are means since the last begin_mean().
    std::vector<JointRow> joints() const { return rigid_ ? rigid_->joints() : std::vector<JointRow>{}; }

    /// m, centre of a named body.
    Vec3<double> place(std::size_t body) const { return rigid_->place(body); }

    /// s, integral over time since the run began of the share of a named body's weight that its contacts carried;
    /// valid when measured().
    double carried(std::size_t body) const { return rigid_->carried(body); }

    /// N s, impulse of a named body's contacts since the run began; valid when measured().
    Vec3<double> contact_impulse(std::size_t body) const { return rigid_->contact_impulse(body); }

    /// Fields of a snapshot; points are this rank's.
    void            copy_points(PointCopy<Exec, Real>& copy) const;
    io::PointFields point_fields() const;
    io::BodyFields  body_fields();

    /// Records of contacts of bodies with bodies and walls.
    std::vector<world::ContactRecord> contacts();

    /// m, surface heights of sand and rocks (TerrainBins::surface).
    std::vector<double> surface_heights(const world::ColumnLattice& lattice);

    /// Saves to a checkpoint, or loads into a simulation of the same scene, with as many ranks for an exact restart.
    /// Call when measured(). Saving does not change later results.
    void transfer(StateFile& file);

    Ledger&       ledger() { return *ledger_; }
    const Ledger& ledger() const { return *ledger_; }

private:
    // Parts of a step, in order.
    void apply_commands(TimeStep& step);
    void measure_before_change(double dt);
    void sort_and_migrate(StageClock& clock);
    void update_sleeping_pages(StageClock& clock);
    void find_contacts(TimeStep& step, double time, StageClock& clock);
    void move_bodies(const TimeStep& step, double time, StageClock& clock);
    void move_sand(double dt, StageClock& clock);
    void measure_if_due(const TimeStep& step, double time, StageClock& clock);

    void wake_sand_near_rocks(StageClock& clock);

    /// Bodies that keep the sand around them awake.
    std::vector<BodyReach> sand_wakers();

    void          set_gravity(const Vec3<double>& gravity);
    void          set_contacts(std::size_t phase);
    void          require_apart(double time);
    void          transfer_contacts(StateFile& file);
    void          list_points();
    void          send_records();
    void          repartition_pages();
    void          repartition_loaded();
    void          list_contacts(double span, StageClock& clock);
    void          measure();
    ContactReport measure_contacts();
    std::int64_t  steps_to_measure() const;
    double        moving_mass() const { return (sand_ ? sand_->mass() : 0) + (rigid_ ? rigid_->mass() : 0); }

    /// Predicted work of this rank, in points, by page.
    decomp::PageLoads page_loads() const;

    /// Energies over all ranks, as of the last substep. Collective.
    ContactEnergies contact_energies() const;

    /// Layout version: cached indices stay valid while this is unchanged.
    std::int64_t layout_version() const
    {
        return (sand_ ? sand_->reorder_count() : 0) + (rigid_ ? rigid_->partition_version() : 0);
    }

    /// Has rocks and their contacts follow the sand that sleeps; empty where rocks or sand do not.
    typename MpmSolver<Exec, Real>::SleepFollower sleep_follower();

    Exec                         exec_;
    decomp::Decomposition<Exec>* decomposition_;
    const scene::Scene&          scene_;
    const world::World&          world_;
    const Plan                   plan_;
    PaceLimits                   limits_;
    double                       free_mass_;       ///< kg, of sand and rocks
    Vec3<double>                 gravity_;         ///< m/s2
    std::int64_t                 phase_   = -1;    ///< that has begun here; -1: none
    bool                         wakes_   = false; ///< whether all sand wakes in the next step
    double                       damping_ = 0;
    Measuring                    measuring_;
    LastStep                     last_;
    StopCheck                    why_stop_; ///< empty: no check

    std::optional<TouchChange>     touch_change_;    ///< of this phase, until pairs that begin to touch are checked
    std::optional<ContactEnergies> loaded_energies_; ///< from a checkpoint, until the next step has responses

    std::optional<WorkBalance<Exec>>            balance_; ///< only on several ranks
    std::optional<MpmSolver<Exec, Real>>        sand_;
    std::optional<DemSolver<Exec>>              rigid_;
    std::optional<SandBodyCoupling<Exec, Real>> coupling_;
    std::optional<Ledger>                       ledger_;
    std::optional<SandGuard>                    guard_;
};

} // namespace tread::solver
