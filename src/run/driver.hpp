#pragma once

#include <cmath>

#include "base/log.hpp"
#include "base/watchdog.hpp"
#include "io/provenance.hpp"
#include "io/run_directory.hpp"
#include "io/summary.hpp"
#include "run/checkpoint_clock.hpp"
#include "run/drive_room.hpp"
#include "run/drive_watch.hpp"
#include "run/phases.hpp"
#include "run/recorder.hpp"
#include "run/snapshots.hpp"
#include "run/surface.hpp"
#include "solver/simulation.hpp"

namespace tread::solver
{
class StateFile;
}

namespace tread::run
{

/// Restart point and limits of a run.
struct DriverOptions
{
    io::Provenance provenance;
    std::string    checkpoint;               ///< checkpoint to continue from; empty = from the start
    double         wall_start     = 0;       ///< wall_clock() of the process's start
    double         walltime_limit = 0;       ///< s since then; 0 = none
    Watchdog*      watchdog       = nullptr; ///< watchdog to notify of steps; none on one rank
};

/// Number of multiples of `every` (s; 0: none) up to `time`; a tolerance of half a nanosecond covers the rounding of a
/// sum of steps.
inline std::int64_t multiples(double time, double every)
{
    return every > 0 ? static_cast<std::int64_t>(std::floor((time + 5e-10) / every)) : 0;
}

/// Runs a simulation through the phases of its scene, and writes the requested output. Collective: all ranks take the
/// same steps; rank 0 writes what is not written in parallel.
template<class Exec, class Real>
class Driver
{
public:
    /// `rooms`: from drive_rooms.
    Driver(const Communicator& communicator, Log& log, const scene::Scene& scene, const world::World& world,
           const io::RunDirectory& directory, const solver::Plan& plan, solver::Simulation<Exec, Real>& simulation,
           std::vector<DriveRoom> rooms, const DriverOptions& options);

    /// Runs all phases and returns nothing; or, when a signal or the wall-time limit ended the run after a checkpoint,
    /// the reason. NumericalError when the run has to stop; report() then has the results so far.
    std::optional<std::string> run();

    /// Fills in steps, substeps, times, errors and stages so far.
    void report(io::Summary& summary, const std::vector<solver::Stage>& stages) const;

private:
    /// State of a run at its last progress message.
    struct Said
    {
        double       wall; ///< wall_clock()
        std::int64_t steps;
        double       time; ///< s simulated
    };

    std::optional<std::string> carry_on();

    void start();
    void resume();
    void load_checkpoint();
    void write_checkpoint();

    Interruption look_outside();
    std::int64_t state_bytes() const;

    void   transfer(solver::StateFile& file);
    void   transfer_files(solver::StateFile& file);
    void   require_same_world(solver::StateFile& file) const;
    void   begin_phase();
    void   end_phase();
    void   pass_on();
    bool   phase_is_over();
    bool   is_at_end_of_bed();
    void   require_on_terrain(const DriveRoom& room, const Vec3<double>& axle) const;
    void   advance();
    void   write_due();
    void   write_row();
    bool   files_are_free();
    void   finish_files();
    void   write_snapshot();
    void   write_bed();
    Said   standing() const { return {wall_clock(), steps_, time_}; }
    void   say_progress();
    void   warn_once(const solver::TimeStep& step);
    double end_time() const;

    const Communicator&                  communicator_;
    Log&                                 log_;
    const scene::Scene&                  scene_;
    const world::World&                  world_;
    solver::Plan                         plan_;
    io::RunDirectory                     directory_;
    solver::Simulation<Exec, Real>&      simulation_;
    DriverOptions                        options_;
    PhaseClock                           phases_;
    std::vector<DriveRoom>               rooms_; ///< one for each driven body
    DriveWatch                           drive_watch_;
    std::optional<Recorder>              recorder_;  ///< on rank 0
    std::optional<Snapshots<Exec, Real>> snapshots_; ///< only if the scene wants snapshots
    solver::StageClock                   clock_;
    std::vector<io::PhaseReport>         ended_;
    SurfaceMap                           surface_; ///< reference for sinkage
    solver::TimeStep                     step_;
    double                               time_          = 0;
    std::int64_t                         steps_         = 0;
    std::int64_t                         substeps_      = 0;
    std::int64_t                         rows_          = 0; ///< number of time-series rows due so far
    std::int64_t                         snapshots_due_ = 0;
    std::int64_t                         last_row_      = -1; ///< step of the last row that was written
    std::int64_t                         last_snapshot_ = -1; ///< step of the last snapshot
    bool                                 warned_        = false;
    double                               wall_start_;
    double                               wall_before_ = 0; ///< s, wall time of the runs that this one continues
    Said                                 said_;
    io::CheckpointReport                 checkpoints_;
    std::int64_t                         restarts_ = 0;
    std::optional<CheckpointClock>       interruptions_;
};

} // namespace tread::run
