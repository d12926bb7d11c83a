#pragma once

#include <string>

#include "base/communicator.hpp"
#include "base/exit_code.hpp"
#include "base/log.hpp"
#include "base/watchdog.hpp"
#include "decomp/decomposition.hpp"
#include "io/run_directory.hpp"
#include "run/restart.hpp"
#include "run/visit.hpp"
#include "scene/scene.hpp"

namespace tread::run
{

enum class BackendChoice
{
    automatic, ///< a GPU if the build and the machine have one
    cpu,
    cuda
};

/// Whether several ranks of a machine may use one GPU.
enum class GpuSharing
{
    refused,
    allowed
};

struct RunOptions
{
    std::string   output;     ///< the run directory
    std::string   scene_file; ///< file of the scene; empty = none
    io::Existing  existing = io::Existing::refuse;
    BackendChoice backend  = BackendChoice::automatic;
    int           threads  = 0; ///< OpenMP threads; 0 = OMP_NUM_THREADS, or the machine's cores divided by its ranks
    GpuSharing    gpus     = GpuSharing::refused;

    RestartOptions restart;
    double         wall_start     = 0; ///< wall_clock() at which the run's wall time begins
    double         walltime_limit = 0; ///< s since then; 0 = none

    Visitor visitor; ///< the calling program; on several ranks all visit at the same steps

    decomp::DecompositionOptions decomposition; ///< for runs on several ranks
};

/// Runs a scene from its first phase to its last. Everything that can refuse it is checked before the run directory is
/// created or anything in it removed: geometry, memory, disk, device, and whether the scene reads files that would be
/// replaced. Writes scene.toml, log.txt, timeseries.h5, snapshots and summary.json; a run stopped by a NumericalError,
/// a signal or the wall-time limit leaves a summary that says so, and its exit code is returned. Continues an earlier
/// run if options.restart says so; if that is finished, nothing is done. Collective: each rank computes with the pages
/// that it owns. Throws InputError and EnvironmentError for errors found before the first step.
/// `watchdog`, on several ranks, is notified of every step. Signals end it early while a SignalWatch lives.
ExitCode run_scene(const Communicator& communicator, Log& log, Watchdog* watchdog, const scene::Scene& scene,
                   const RunOptions& options);

} // namespace tread::run
