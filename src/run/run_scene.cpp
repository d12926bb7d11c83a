#include "run/run_scene.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <omp.h>

#include "backend/backends.hpp"
#include "backend/memory.hpp"
#include "base/host_memory.hpp"
#include "base/version.hpp"
#include "decomp/single_rank.hpp"
#include "io/checkpoint_file.hpp"
#include "io/files.hpp"
#include "io/progress.hpp"
#include "run/agreement.hpp"
#include "run/answers.hpp"
#include "run/drive_room.hpp"
#include "run/driver.hpp"
#include "run/estimate.hpp"
#include "run/left_out.hpp"
#include "run/on_ranks.hpp"
#include "run/plausibility.hpp"
#include "run/rank_devices.hpp"
#include "run/threads.hpp"
#include "scene/input_files.hpp"
#include "scene/resolved.hpp"
#include "scene/soil_text.hpp"
#include "solver/ranks/page_loads.hpp"
#include "world/bed.hpp"

namespace tread::run
{
namespace
{

Backend choose_backend(BackendChoice choice)
{
    if (choice == BackendChoice::cpu) { return Backend::cpu; }
    if (device_count() > 0) { return Backend::cuda; }
    if (choice == BackendChoice::automatic) { return Backend::cpu; }
    throw EnvironmentError(has_gpu ? "--backend cuda: this machine has no CUDA device that this process can use"
                                   : "--backend cuda: this build has no GPU backend (no CUDA compiler was found when "
                                     "it was made)");
}

const char* name_of(Backend backend) { return backend == Backend::cpu ? "cpu" : "cuda"; }

/// Chooses this rank's backend, once all ranks agree on the run.
Backend agreed_backend(const Communicator& communicator, const scene::Scene& scene, const RunOptions& options)
{
    Backend           backend = Backend::cpu;
    std::vector<Fact> facts;
    on_every_rank(communicator,
                  [&]
                  {
                      backend = choose_backend(options.backend);
                      if (communicator.size() > 1) { facts = facts_of_run(scene, options, name_of(backend)); }
                  });
    require_agreement(communicator, scene::resolved_toml(scene), facts);
    return backend;
}

void log_plan(Log& log, const scene::Scene& scene, const world::World& world, const std::vector<solver::Stage>& stages)
{
    log.info(fmt::format("{} points, {} bodies ({} rocks)", world.sand.size(), world.bodies.size(),
                         static_cast<std::int64_t>(world.bodies.size()) - world.bodies.named));
    for (const auto& form : world.templates)
    {
        for (const std::string& remark : form.remarks) { log.info(fmt::format("shape '{}': {}", form.name, remark)); }
        for (const std::string& warning : form.warnings)
        {
            log.warning(fmt::format("shape '{}': {}", form.name, warning));
        }
    }
    for (const solver::Stage& stage : stages)
    {
        if (stage.on) { continue; }
        log.info(fmt::format("left out: {} - {}{}", stage.name, stage.why, price_text(stage, scene, world)));
    }
}

/// Data of a run that does not depend on the backend.
struct Job
{
    const Communicator&        communicator;
    Log&                       log;
    const scene::Scene&        scene;
    world::World&              world;
    std::vector<DriveRoom>     rooms; ///< one for each driven body
    solver::Plan               plan;
    Estimate                   wants;
    const RunOptions&          options;
    std::vector<solver::Stage> stages;
    RestartPlan                restart;
    io::NewRun                 place;
    io::RunDirectory           directory; ///< exists once the run has begun
    DriverOptions              driver;
    io::Summary                summary;
};

/// Empty on one rank.
template<class Exec>
std::optional<decomp::Decomposition<Exec>> decompose(const Exec& exec, Job& job)
{
    std::optional<decomp::Decomposition<Exec>> decomposition;
    if (job.communicator.size() == 1) { return decomposition; }
    decomposition.emplace(job.communicator, exec, job.options.decomposition);
    job.log.info(fmt::format("transport: {}", decomposition->transport.description()));
    job.log.info(fmt::format("partition: {}", solver::share_out(*decomposition, job.world)));
    return_freed_memory();
    return decomposition;
}

/// Refuses features that several ranks do not support yet.
void require_ranks_can(const Communicator& communicator, const scene::Scene& scene)
{
    if (scene.numerics.volume_strain == scene::VolumeStrain::cell_average)
    {
        decomp::require_single_rank(communicator, "scenes with volume_strain = \"cell-average\" run");
    }
    if (scene::softening_length(scene) > 0)
    {
        decomp::require_single_rank(communicator, "scenes with softening_length run");
    }
    if (!scene.grid.refine.empty()) { decomp::require_single_rank(communicator, "scenes with [grid] refine run"); }
}

template<class Exec, class Real>
ExitCode run_on(const Exec& exec, Job& job)
{
    std::optional<decomp::Decomposition<Exec>> decomposition = decompose(exec, job);
    const Visitor&                             visitor       = job.options.visitor;
    const auto                                 drop          = [&visitor](solver::Simulation<Exec, Real>* simulation)
    {
        if (!visitor.keeps_memory || !visitor.keeps_memory()) { delete simulation; }
    };
    const std::unique_ptr<solver::Simulation<Exec, Real>, decltype(drop)> simulation(
        new solver::Simulation<Exec, Real>(exec, job.scene, job.world, job.plan,
                                           decomposition ? &*decomposition : nullptr),
        drop);
    Driver<Exec, Real> driver(job.communicator, job.log, job.scene, job.world, job.directory, job.plan, *simulation,
                              job.rooms, job.driver);
    try
    {
        const std::optional<std::string> interruption = driver.run();
        job.summary.outcome.reason                    = interruption ? "stopped by " + *interruption : "all phases ran";
        if (interruption)
        {
            job.summary.outcome.status    = io::RunStatus::stopped;
            job.summary.outcome.exit_code = ExitCode::stopped_early;
        }
    }
    catch (const NumericalError& error)
    {
        if (!job.communicator.all_arrive(agreement_timeout)) { throw; } // only this rank failed
        job.log.warning(error.what());
        job.summary.outcome.status    = io::RunStatus::failed;
        job.summary.outcome.exit_code = error.code();
        job.summary.outcome.reason    = error.what();
    }
    if (job.driver.watchdog != nullptr) { job.driver.watchdog->end_steps(); }
    driver.report(job.summary, job.stages);
    return job.summary.outcome.exit_code;
}

template<class Exec>
ExitCode run_precision(const Exec& exec, Job& job)
{
    return job.scene.numerics.precision == scene::Precision::single_ ? run_on<Exec, float>(exec, job)
                                                                     : run_on<Exec, double>(exec, job);
}

void log_start(Job& job)
{
    Log& log = job.log;
    log.info(fmt::format("tread {} ({}): {}", version, commit(), job.scene.title));
    log.info(fmt::format("backend {}, {} rank(s), {} thread(s), {} precision", job.summary.run.backend,
                         job.summary.run.ranks, job.summary.run.threads,
                         job.scene.numerics.precision == scene::Precision::single_ ? "single" : "double"));
    job.summary.bed = world::describe_bed(job.scene, job.world);
    log_plan(log, job.scene, job.world, job.stages);
    for (const Warning& warning : plausibility(job.scene, job.world, job.wants, job.rooms))
    {
        job.summary.warnings.push_back(text_of(warning));
        log.warning(job.summary.warnings.back());
    }
    for (const std::string& line : scene::soil_lines(job.scene)) { log.info(line); }
    for (const std::string& line : world::bed_lines(job.summary.bed)) { log.info(line); }
    for (const std::string& note : drive_notes(job.scene, job.world, job.rooms)) { log.info(note); }
}

/// Throws EnvironmentError, on all ranks, where the backend's memory or the disk is too small.
void require_rooms(const Job& job, const char* memory, std::int64_t wanted, std::int64_t free)
{
    on_every_rank(job.communicator, [&] { require_room(memory, wanted, free); });
    if (job.restart.existing == io::Existing::resume) { return; }
    on_root(job.communicator,
            [&]
            {
                require_disk(job.directory.path(), job.wants.disk.least,
                             io::free_space(job.directory.path()) + job.directory.bytes_to_remove());
            });
}

/// All checks that may refuse the run are done: from here on files change.
void begin(Job& job)
{
    const bool goes_on = job.restart.existing == io::Existing::resume;
    job.directory      = io::RunDirectory::create(job.communicator, job.place, job.restart.lock);
    job.log.open(job.directory.log(), goes_on ? LogFile::continued : LogFile::anew);
    log_start(job);
    for (const std::string& remark : job.restart.remarks) { job.log.warning(remark); }
}

ExitCode run_backend(Backend backend, Job& job)
{
    Counters           counters;
    const std::int64_t wanted = memory_of_rank(job.wants, job.communicator.size());
    counters.expect(wanted);
    ExitCode code = ExitCode::finished;
    if (backend == Backend::cpu)
    {
        const Cpu cpu{&counters};
        require_rooms(job, "host", wanted, free_bytes(cpu));
        begin(job);
        code                             = run_precision(cpu, job);
        job.summary.cost.peak_host_bytes = counters.peak_bytes();
    }
#ifdef TREAD_WITH_CUDA
    else
    {
        const int    number = device_of_rank(job.communicator, job.options.gpus);
        const Device device(number, counters);
        require_rooms(job, "device", wanted, free_bytes(device.gpu()));
        begin(job);
        for (const std::string& name : log_devices(job.communicator, job.log, number))
        {
            job.summary.run.devices.push_back(name);
        }
        job.driver.provenance.devices      = job.summary.run.devices;
        code                               = run_precision(device.gpu(), job);
        job.summary.cost.peak_device_bytes = counters.peak_bytes();
    }
#endif
    return code;
}

/// Logs the answers. On rank 0, which has the time series.
void log_answers(Job& job)
{
    io::Summary& summary = job.summary;
    summary.answers      = make_answers(job.scene, job.directory.time_series(), summary.phases.size());
    if (summary.resolution.grid_error)
    {
        add_grid_error(job.scene, *summary.resolution.grid_error, summary.answers);
        job.log.info("grid error: " +
                     io::grid_error_line(*summary.resolution.grid_error, last_drive(job.scene, summary.answers)));
    }
    for (const std::string& line : answer_lines(summary.answers)) { job.log.info(line); }
}

/// UTC; for a restarted run, the start of its first part.
std::string start_of(const Communicator& communicator, const std::string& checkpoint)
{
    std::string start;
    on_root(communicator,
            [&] { start = checkpoint.empty() ? io::utc_now() : io::CheckpointReader(checkpoint).text("start"); });
    return communicator.broadcast(start);
}

/// Files that the run reads and must not overwrite. A run that resumes keeps its own files: its scene.toml may be the
/// scene.
std::vector<io::NeededFile> needed_files(const scene::Scene& scene, const RunOptions& options,
                                         const RestartPlan& restart)
{
    std::vector<io::NeededFile> needed;
    for (const scene::InputFile& file : scene::input_files(scene)) { needed.push_back({file.path, file.key}); }
    if (restart.existing == io::Existing::resume) { return needed; }
    if (!options.scene_file.empty()) { needed.push_back({options.scene_file, "the scene"}); }
    if (!restart.checkpoint.empty()) { needed.push_back({restart.checkpoint, "--restart"}); }
    return needed;
}

} // namespace

ExitCode run_scene(const Communicator& communicator, Log& log, Watchdog* watchdog, const scene::Scene& scene,
                   const RunOptions& options)
{
    const Backend backend = agreed_backend(communicator, scene, options);
    const int     threads = choose_threads(communicator, options.threads);
    omp_set_num_threads(threads);
    RestartPlan restart = plan_restart(communicator, scene, options.restart, options.output, options.existing);
    if (restart.finished)
    {
        log.info(fmt::format("{}: the run is finished; nothing is left to do", options.output));
        return ExitCode::finished;
    }
    const io::NewRun place{options.output, restart.existing, scene::resolved_toml(scene),
                           needed_files(scene, options, restart)};
    io::RunDirectory::require_free(communicator, place);
    world::World world = world::build_world(scene);
    return_freed_memory();
    const solver::Plan plan = solver::make_plan(scene, world, communicator.size());
    require_ranks_can(communicator, scene);
    const std::string start = start_of(communicator, restart.checkpoint);

    Job job{communicator,
            log,
            scene,
            world,
            drive_rooms(scene, world),
            plan,
            estimate(scene, world, plan),
            options,
            solver::stages(scene, plan, communicator.size()),
            std::move(restart),
            place,
            io::RunDirectory::at(options.output),
            {},
            {}};

    io::RunIdentity& run = job.summary.run;
    run                  = {scene::scene_hash(scene),
                            name_of(backend),
                            {},
                            communicator.size(),
                            threads,
                            0,
                            static_cast<std::int64_t>(world.bodies.size()),
                            start};
    job.driver           = {{run.scene_hash, run.backend, {}, run.ranks, run.start},
                            job.restart.checkpoint,
                            options.wall_start,
                            options.walltime_limit,
                            watchdog,
                            options.visitor};
    const ExitCode code  = run_backend(backend, job);
    log.info(fmt::format("\n{}", io::timing_table(job.summary.cost.stages, job.summary.cost.wall_s)));
    log.info(fmt::format("errors: mass {:.3g}, momentum {:.3g}, energy {:.3g}", job.summary.errors.mass,
                         job.summary.errors.momentum, job.summary.errors.energy));
    log.info("resolution: " + io::verdict_line(job.summary));
    if (code != ExitCode::finished) { log.info(job.summary.outcome.reason); }
    on_root(communicator, [&] { log_answers(job); });
    on_root(communicator, [&] { io::write_summary(job.directory.summary(), job.summary); });
    return code;
}

} // namespace tread::run
