#include "run/driver.hpp"

#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "backend/instantiate.hpp"
#include "io/checkpoints.hpp"
#include "io/progress.hpp"
#include "run/resolution_figures.hpp"

namespace tread::run
{
namespace
{

constexpr double progress_every = 5; ///< s of wall time

std::vector<io::NamedMesh> meshes(const world::World& world)
{
    std::vector<io::NamedMesh> named;
    for (const auto& form : world.templates) { named.push_back({form.name, form.mesh}); }
    return named;
}

} // namespace

template<class Exec, class Real>
Driver<Exec, Real>::Driver(const Communicator& communicator, Log& log, const scene::Scene& scene,
                           const world::World& world, const io::RunDirectory& directory, const solver::Plan& plan,
                           solver::Simulation<Exec, Real>& simulation, std::vector<DriveRoom> rooms,
                           const DriverOptions& options)
    : communicator_(communicator)
    , log_(log)
    , scene_(scene)
    , world_(world)
    , plan_(plan)
    , directory_(directory)
    , simulation_(simulation)
    , options_(options)
    , phases_(scene, rolling_radii(scene, world))
    , rooms_(std::move(rooms))
    , surface_(scene, world)
    , wall_start_(wall_clock())
    , said_{wall_start_, 0, 0}
{
    if (plan.snapshots)
    {
        io::SnapshotWriter files(communicator, directory.snapshots(), options.provenance);
        if (plan.bodies) { files.write_shapes(meshes(world)); }
        snapshots_.emplace(communicator, simulation.exec(), std::move(files));
    }
    on_root(communicator, [&] { io::Checkpoints(directory_.checkpoints()).prepare(); });
}

/// However it ends, all rows of the time series are in the file.
template<class Exec, class Real>
std::optional<std::string> Driver<Exec, Real>::run()
{
    try
    {
        std::optional<std::string> interruption = carry_on();
        finish_files();
        return interruption;
    }
    catch (const NumericalError&)
    {
        finish_files();
        throw;
    }
    catch (const StoppedInStep& stop)
    {
        finish_files();
        return fmt::format("{} within step {}, of which no checkpoint can be written; the newest is {}", stop.what(),
                           steps_ + 1,
                           checkpoints_.newest.empty() ? "none: a restart begins anew" : checkpoints_.newest);
    }
}

template<class Exec, class Real>
std::optional<std::string> Driver<Exec, Real>::carry_on()
{
    if (options_.watchdog != nullptr) { options_.watchdog->begin_steps(); } // output before the first step counts too
    if (options_.checkpoint.empty()) { start(); }
    else { resume(); }
    interruptions_.emplace(scene_.checkpoint, options_.walltime_limit, options_.wall_start, time_, steps_);
    interruptions_->expect(state_bytes());
    simulation_.set_stop_check([this] { return interruptions_->look_within_step(communicator_); });
    while (!phases_.finished())
    {
        const Interruption asked = look_outside();
        if (asked.write) { write_checkpoint(); }
        if (asked.stop) { return asked.why; }
        advance();
        write_due();
        pass_on();
    }
    // Skip what the last step has already written.
    if (last_row_ < steps_) { write_row(); }
    if (last_snapshot_ < steps_) { write_snapshot(); }
    return {};
}

/// Estimates the size of a checkpoint, on rank 0 with the time series.
template<class Exec, class Real>
std::int64_t Driver<Exec, Real>::state_bytes() const
{
    constexpr std::int64_t of_point = 31 * sizeof(Real) + 46, of_body = 2500, of_file = 1000000;
    std::error_code        none;
    const auto             series = std::filesystem::file_size(directory_.time_series(), none);
    return of_file + of_point * communicator_.sum(simulation_.points()) +
           of_body * static_cast<std::int64_t>(world_.bodies.size()) + (none ? 0 : static_cast<std::int64_t>(series));
}

template<class Exec, class Real>
void Driver<Exec, Real>::start()
{
    on_root(communicator_,
            [&] { recorder_.emplace(directory_, scene_, world_, communicator_.size(), options_.provenance); });
    begin_phase();
    write_row();
    write_snapshot();
}

/// Only a measured state can be saved; that takes a few steps at most.
template<class Exec, class Real>
Interruption Driver<Exec, Real>::look_outside()
{
    return simulation_.measured() ? interruptions_->look(communicator_, time_, steps_) : Interruption{};
}

template<class Exec, class Real>
void Driver<Exec, Real>::advance()
{
    if (simulation_.measured())
    {
        step_ = solver::choose_step(scene_.time, simulation_.limits(), simulation_.pace(), step_.dt);
    }
    solver::TimeStep step = step_;
    step.dt               = solver::fitted(step.dt, phases_.latest_end() - time_);
    warn_once(step);

    std::vector<solver::BodyCommand> commands;
    for (std::size_t b = 0; b < scene_.bodies.size(); ++b) { commands.push_back(phases_.command(b, time_ + step.dt)); }
    simulation_.command(commands, phases_.phase().damping);
    clock_.begin_step(steps_);
    step = simulation_.step(step, time_, clock_);
    if (options_.watchdog != nullptr) { options_.watchdog->advance(); }
    time_ += step.dt;
    ++steps_;
    substeps_ += step.substeps;
    say_progress();
}

template<class Exec, class Real>
void Driver<Exec, Real>::warn_once(const solver::TimeStep& step)
{
    const auto excess = solver::over_limit(step, simulation_.limits(), simulation_.pace());
    if (!excess || warned_) { return; }
    log_.warning(fmt::format("t = {:.6g} s: {} (said once a phase)", time_, *excess));
    warned_ = true;
}

template<class Exec, class Real>
void Driver<Exec, Real>::write_due()
{
    // Write at the first step at or past each time. A row needs a measured state and waits for the next measurement:
    // measuring for its sake would change the steps that follow.
    const std::int64_t rows      = multiples(time_, scene_.output.every);
    const std::int64_t snapshots = multiples(time_, scene_.output.snapshots_every);
    if (rows > rows_ && simulation_.measured())
    {
        rows_ = rows;
        write_row();
    }
    if (snapshots > snapshots_due_)
    {
        snapshots_due_ = snapshots;
        write_snapshot();
    }
}

template<class Exec, class Real>
void Driver<Exec, Real>::write_row()
{
    const auto write = [&]
    {
        const solver::Census     now     = simulation_.census();
        const solver::EnergyRow  energy  = simulation_.ledger().energy(now);
        const solver::BalanceRow balance = simulation_.ledger().balance(now);
        auto                     bodies  = simulation_.named_bodies();
        const auto*              ranks   = simulation_.balance();
        surface_.press(bodies);
        for (std::size_t b = 0; b < bodies.size(); ++b) { bodies[b].surface = surface_.under(b, bodies[b]); }
        const auto on_file = [&]
        {
            if (ranks != nullptr) { recorder_->write_ranks(time_, *ranks); }
            recorder_->write(time_, bodies, energy, balance);
            if (files_are_free()) { recorder_->flush(); }
        };
        on_root(communicator_, on_file);
        simulation_.begin_mean();
    };
    clock_.run(simulation_.exec(), solver::stage::output, write);
    last_row_ = steps_;
}

/// Rows wait while a snapshot is being written; an error of that snapshot is thrown here.
template<class Exec, class Real>
bool Driver<Exec, Real>::files_are_free()
{
    if (!snapshots_) { return true; }
    if (snapshots_->writing()) { return false; }
    snapshots_->finish();
    return true;
}

/// Waits for all snapshots, and writes the rows that waited for them.
template<class Exec, class Real>
void Driver<Exec, Real>::finish_files()
{
    if (snapshots_) { snapshots_->finish(); }
    if (recorder_) { recorder_->flush(); }
}

template<class Exec, class Real>
void Driver<Exec, Real>::write_snapshot()
{
    if (!snapshots_) { return; }
    last_snapshot_ = steps_;
    clock_.run(simulation_.exec(), solver::stage::snapshots, [&] { snapshots_->write(time_, simulation_); });
}

template<class Exec, class Real>
double Driver<Exec, Real>::end_time() const
{
    double end = phases_.latest_end();
    for (std::size_t p = phases_.index() + 1; p < scene_.phases.size(); ++p)
    {
        const scene::Phase& phase = scene_.phases[p];
        end += phase.until == scene::StopRule::duration ? phase.duration : phase.max_duration;
    }
    return end;
}

template<class Exec, class Real>
void Driver<Exec, Real>::say_progress()
{
    const Said   now    = standing();
    const double passed = now.wall - said_.wall;
    if (passed < progress_every) { return; }
    const auto steps = static_cast<double>(now.steps - said_.steps);
    log_.info(io::progress_line({phases_.phase().name, time_, end_time(), steps_, steps / passed,
                                 (now.time - said_.time) / passed, step_.dt, step_.limit}));
    said_ = now;
}

template<class Exec, class Real>
void Driver<Exec, Real>::report(io::Summary& summary, const std::vector<solver::Stage>& stages) const
{
    summary.steps    = steps_;
    summary.substeps = substeps_;
    summary.time     = time_;
    summary.wall_s   = wall_before_ + wall_clock() - wall_start_;
    summary.points   = communicator_.sum(simulation_.points());
    summary.stages   = clock_.reports(stages);
    summary.errors   = simulation_.ledger().errors();
    summary.phases   = ended_;
    summary.restarts = restarts_;
    summary.asleep   = simulation_.mean_asleep();

    summary.checkpoints   = checkpoints_;
    summary.points_across = points_across(simulation_.extremes(), world_);

    const std::optional<DrivenWheel> wheel = driven_wheel(scene_, world_, plan_);
    summary.figures = figures(simulation_.extremes(), summary.errors, simulation_.limits(), world_, plan_, wheel);
    if (plan_.coupling) { summary.grid_error = grid_error(wheel, contact_cells(simulation_.extremes(), world_)); }
}

#define TREAD_INSTANTIATE(Exec, Real) template class Driver<Exec, Real>
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::run
