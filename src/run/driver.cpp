#include "run/driver.hpp"

#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "backend/instantiate.hpp"
#include "base/host_memory.hpp"
#include "io/checkpoints.hpp"
#include "run/resolution_figures.hpp"
#include "world/world_measures.hpp"

namespace tread::run
{

template<class Exec, class Real>
Driver<Exec, Real>::Driver(const Communicator& communicator, Log& log, const scene::Scene& scene, world::World& world,
                           const io::RunDirectory& directory, const solver::Plan& plan,
                           solver::Simulation<Exec, Real>& simulation, std::vector<DriveRoom> rooms,
                           const DriverOptions& options)
    : communicator_(communicator)
    , log_(log)
    , scene_(scene)
    , world_(world)
    , body_measures_(world::body_measures(world.bodies))
    , plan_(plan)
    , directory_(directory)
    , simulation_(simulation)
    , options_(options)
    , rooms_(std::move(rooms))
    , loop_(scene, world, simulation)
    , output_({communicator, scene, world, plan, directory, options.provenance}, loop_)
    , visits_(communicator, log, world, plan, options.visitor, loop_)
{
    on_root(communicator, [&] { io::Checkpoints(directory_.checkpoints()).prepare(); });
    begin_simulation();
    wall_start_ = wall_clock();
    messages_   = {wall_start_};
}

/// However it ends, all rows of the time series are in the file.
template<class Exec, class Real>
std::optional<std::string> Driver<Exec, Real>::run()
{
    try
    {
        std::optional<std::string> interruption = run_to_end();
        output_.finish();
        return interruption;
    }
    catch (const NumericalError&)
    {
        output_.finish();
        throw;
    }
    catch (const EnvironmentError&)
    {
        output_.keep_rows();
        throw;
    }
    catch (const StoppedInStep& stop)
    {
        output_.finish();
        const std::string& newest = history_.checkpoints.newest;
        return fmt::format("{} within step {}, of which no checkpoint can be written; the newest is {}", stop.what(),
                           loop_.progress.steps + 1, newest.empty() ? "none: a restart begins anew" : newest);
    }
}

template<class Exec, class Real>
std::optional<std::string> Driver<Exec, Real>::run_to_end()
{
    if (options_.watchdog != nullptr) { options_.watchdog->begin_steps(); } // output before the first step counts too
    if (options_.checkpoint.empty()) { start(); }
    else { resume(); }
    const RunProgress& progress = loop_.progress;
    checkpoint_clock_.emplace(scene_.checkpoint, options_.walltime_limit, options_.wall_start, progress.time,
                              progress.steps);
    checkpoint_clock_->expect(state_bytes());
    checkpoint_clock_->set_stop_source(options_.visitor.stop_asked);
    simulation_.set_stop_check([this] { return checkpoint_clock_->check_within_step(communicator_); });
    std::optional<std::string> interruption = run_phases(loop_, calls());
    if (interruption) { return interruption; }
    output_.write_last();
    visits_.visit_last();
    return {};
}

template<class Exec, class Real>
LoopCalls Driver<Exec, Real>::calls()
{
    LoopCalls calls;
    calls.reason_to_stop = [this] { return checkpoint_or_stop(); };
    calls.adjust         = [this](std::vector<solver::BodyCommand>& commands) { visits_.steer(commands); };
    calls.before_step    = [this](const solver::TimeStep& step) { before_step(step); };
    calls.after_step     = [this] { after_step(); };
    calls.early_end      = [this] { return end_of_bed(); };
    calls.phase_ends     = [this] { end_phase(); };
    calls.phase_begins   = [this] { begin_phase(); };
    return calls;
}

/// The description of the rocks goes before their pairs come; a checkpoint needs it until it is loaded.
template<class Exec, class Real>
void Driver<Exec, Real>::begin_simulation()
{
    if (options_.checkpoint.empty()) { world::release_rocks(world_); }
    return_freed_memory();
    simulation_.begin();
    world_.contacts = {};
}

template<class Exec, class Real>
void Driver<Exec, Real>::start()
{
    output_.begin();
    begin_phase();
    output_.write_row();
    output_.write_snapshot();
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

/// Writes a checkpoint if one is due, and has the visitor come; returns the reason if the run has to stop. Only a
/// measured state can be saved; that takes a few steps at most.
template<class Exec, class Real>
std::optional<std::string> Driver<Exec, Real>::checkpoint_or_stop()
{
    if (!simulation_.measured()) { return {}; }
    const Interruption due = checkpoint_clock_->check(communicator_, loop_.progress.time, loop_.progress.steps);
    if (due.write) { write_checkpoint(); }
    if (due.stop) { return due.why; }
    std::optional<std::string> reason = visits_.visit_if_due();
    if (reason) { write_checkpoint(); }
    return reason;
}

template<class Exec, class Real>
void Driver<Exec, Real>::before_step(const solver::TimeStep& step)
{
    const auto warning = limit_warning(messages_, step, loop_.progress.time, simulation_.limits(), simulation_.pace());
    if (warning) { log_.warning(*warning); }
    loop_.clock.begin_step(loop_.progress.steps);
}

template<class Exec, class Real>
void Driver<Exec, Real>::after_step()
{
    if (options_.watchdog != nullptr) { options_.watchdog->advance(); }
    log_progress(log_, messages_, scene_, loop_.phase, loop_.progress, output_.answers());
    output_.after_step();
}

template<class Exec, class Real>
void Driver<Exec, Real>::report(io::Summary& summary, const std::vector<solver::Stage>& stages) const
{
    summary.cost.steps    = loop_.progress.steps;
    summary.cost.substeps = loop_.progress.substeps;
    summary.cost.time     = loop_.progress.time;
    summary.cost.wall_s   = wall_time();
    summary.run.points    = communicator_.sum(simulation_.points());
    summary.cost.stages   = loop_.clock.reports(stages);
    summary.errors        = simulation_.ledger().errors();
    summary.phases        = ended_;
    summary.cost.restarts = history_.restarts;
    summary.cost.asleep   = simulation_.mean_asleep();

    summary.cost.rocks_asleep = simulation_.mean_rocks_asleep();

    summary.cost.checkpoints         = history_.checkpoints;
    summary.resolution.points_across = points_across(simulation_.extremes(), world_);

    const std::optional<DrivenWheel> wheel = driven_wheel(scene_, world_, plan_);
    summary.resolution.figures =
        figures(simulation_.extremes(), summary.errors, simulation_.limits(), world_, plan_, wheel);
    if (plan_.coupling)
    {
        summary.resolution.grid_error = grid_error(wheel, contact_cells(simulation_.extremes(), world_));
    }
}

#define TREAD_INSTANTIATE(Exec, Real) template class Driver<Exec, Real>
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::run
