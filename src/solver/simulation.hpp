#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/snapshot.hpp"
#include "solver/body_command.hpp"
#include "solver/body_row.hpp"
#include "solver/dem_solver.hpp"
#include "solver/extremes.hpp"
#include "solver/ledger.hpp"
#include "solver/mpm_solver.hpp"
#include "solver/plan.hpp"
#include "solver/sand_body_coupling.hpp"
#include "solver/sand_guard.hpp"
#include "solver/stage_clock.hpp"
#include "solver/time_step.hpp"
#include "world/world.hpp"

namespace tread::solver
{

class StateFile;

/// The state of a scene on one backend, and one step of it. Parts that the plan leaves out do not exist. With a
/// decomposition every call is collective, and what comes back is the same on all ranks unless a line says otherwise.
template<class Exec, class Real>
class Simulation
{
public:
    static constexpr int most_unmeasured = 8; ///< steps without a measuring

    /// `decomposition`: who owns which page; null on one rank.
    Simulation(const Exec& exec, const scene::Scene& scene, const world::World& world, const Plan& plan,
               decomp::Decomposition<Exec>* decomposition = nullptr);

    const Exec& exec() const { return exec_; }

    /// What bounds the steps of this scene.
    const PaceLimits& limits() const { return limits_; }

    /// Measured by the last step.
    const Pace& pace() const { return pace_; }

    /// Share of the weight that was out of balance in the last step.
    double unbalanced() const { return unbalanced_; }

    /// What was worst in all steps that were measured.
    const Extremes& extremes() const { return extremes_; }

    /// How the work fell to the ranks so far; null on one rank.
    const decomp::BalanceRow* balance() const { return balance_ ? &balance_->row() : nullptr; }

    /// The scene must have sand.
    MpmSolver<Exec, Real>& sand() { return *sand_; }

    /// Mean share of the points that slept so far; nothing where none may.
    std::optional<double> mean_asleep() const { return sand_ ? sand_->mean_asleep() : std::nullopt; }

    /// Of this rank.
    std::int64_t points() const { return sand_ ? sand_->count() : 0; }

    /// Tells the named bodies what to do (held, driven, free) until the next call; `damping` of the phase.
    void command(const std::vector<BodyCommand>& commands, double damping);

    /// Within a step of many substeps `why` is asked from time to time, by all ranks together: what it returns stops
    /// the run there (StoppedInStep).
    void set_stop_check(std::function<std::optional<std::string>()> why) { why_stop_ = std::move(why); }

    /// One MPM step of `step.dt`, or a shorter one where a command has made a body too fast for it, with its contact
    /// substeps (docs/theory.md#coupling). NumericalError, with what, where and
    /// which limit, when the state cannot be trusted any more; `time` is for that message. What moves little is
    /// measured every few steps only, which pace() and unbalanced() then follow; lists of contacts and N are those of
    /// the first of these.
    TimeStep step(TimeStep step, double time, StageClock& clock);

    /// Whether pace() is of the last step: only then is there reason to choose another dt.
    bool measured() const { return unmeasured_ == 0; }

    /// Of the present state; measures first.
    Census census();

    /// The named bodies; force and torque are means since the last begin_mean().
    std::vector<BodyRow> named_bodies();
    void                 begin_mean();

    /// m, centre of a named body.
    Vec3<double> place(std::size_t body) const { return rigid_->place(body); }

    /// s, the integral over time since the run began of the share of a named body's weight that its contacts carried;
    /// when measured().
    double carried(std::size_t body) const { return rigid_->carried(body); }

    /// What a snapshot shows. Points are this rank's.
    void            copy_points(PointCopy<Exec, Real>& copy) const;
    io::PointFields point_fields() const;
    io::BodyFields  body_fields();

    /// Of bodies with bodies and walls.
    std::vector<world::ContactRecord> contacts();

    /// m, of sand and rocks (TerrainBins::surface).
    std::vector<double> surface_heights(const world::ColumnLattice& lattice);

    /// Into a checkpoint, or out of it into a simulation of the same scene, on as many ranks if it is to be exact; when
    /// measured(). Saving changes nothing that comes after it.
    void transfer(StateFile& file);

    /// Whether what is saved now can be loaded to the bit: on several ranks what bodies and their contacts are listed
    /// by is not saved.
    bool saves_exactly() const { return decomposition_ == nullptr || !rigid_; }

    Ledger&       ledger() { return *ledger_; }
    const Ledger& ledger() const { return *ledger_; }

private:
    void transfer_balance(StateFile& file);
    void sort_and_migrate();
    void update_sleeping_pages();
    void repartition_pages();
    void apply_commands(TimeStep& step);
    void find_contacts(const TimeStep& step, StageClock& clock);
    void substeps(const TimeStep& step, double time, StageClock& clock);
    void coupled_substep(double dt, StageClock& clock);
    void run_batch(double dt, std::int64_t done, std::int64_t count, StageClock& clock);
    void run_substeps(double dt, std::int64_t count, StageClock& clock);
    void look_outside();
    bool in_one_launch(double dt, std::int64_t count, StageClock& clock);
    void measure();
    void choose_measuring();

    /// Which points, in which places of memory, and which bodies are on this rank stays while this does.
    std::int64_t layout_version() const
    {
        return (sand_ ? sand_->reorder_count() : 0) + (rigid_ ? rigid_->partition_version() : 0);
    }

    Exec                                 exec_;
    decomp::Decomposition<Exec>*         decomposition_;
    const scene::Scene&                  scene_;
    const world::World&                  world_;
    Plan                                 plan_;
    PaceLimits                           limits_;
    Pace                                 pace_;
    Extremes                             extremes_;
    Vec3<double>                         gravity_;
    double                               weight_; ///< N, of sand and rocks
    double                               unbalanced_ = 1;
    double                               damping_    = 0;
    TimeStep                             last_;                 ///< step, and
    double                               last_time_        = 0; ///< s, when it began
    std::int64_t                         unmeasured_       = 0; ///< steps since the last measuring
    std::int64_t                         measure_every_    = 1; ///< steps
    std::int64_t                         steps_            = 0; ///< taken
    std::int64_t                         balanced_version_ = 0; ///< layout_version() that the balance has noted
    std::optional<decomp::Balance<Exec>> balance_;              ///< only on several ranks

    std::function<std::optional<std::string>()> why_stop_; ///< empty: nobody asks
    std::optional<MpmSolver<Exec, Real>>        sand_;
    std::optional<DemSolver<Exec>>              rigid_;
    std::optional<SandBodyCoupling<Exec, Real>> coupling_;
    std::optional<Ledger>                       ledger_;
    std::optional<SandGuard>                    guard_;
};

} // namespace tread::solver
