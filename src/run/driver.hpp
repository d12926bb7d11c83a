#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/log.hpp"
#include "base/watchdog.hpp"
#include "io/provenance.hpp"
#include "io/run_directory.hpp"
#include "io/summary.hpp"
#include "run/checkpoint_clock.hpp"
#include "run/drive_room.hpp"
#include "run/drive_watch.hpp"
#include "run/progress_messages.hpp"
#include "run/run_output.hpp"
#include "run/time_loop.hpp"
#include "run/visits.hpp"

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
    Visitor        visitor        = {};
};

/// What a run keeps of the runs that it continues.
struct RestartHistory
{
    double               wall     = 0; ///< s, wall time of the earlier runs
    std::int64_t         restarts = 0;
    io::CheckpointReport checkpoints; ///< including this run's
};

/// Runs a simulation through the phases of its scene, and writes the requested output. Collective: all ranks take the
/// same steps; rank 0 writes what is not written in parallel.
template<class Exec, class Real>
class Driver
{
public:
    /// `rooms`: from drive_rooms. `world`: loses its rocks (release_rocks) once the run has begun.
    Driver(const Communicator& communicator, Log& log, const scene::Scene& scene, world::World& world,
           const io::RunDirectory& directory, const solver::Plan& plan, solver::Simulation<Exec, Real>& simulation,
           std::vector<DriveRoom> rooms, const DriverOptions& options);
    Driver(const Driver&)            = delete;
    Driver& operator=(const Driver&) = delete;

    /// Runs all phases and returns nothing; or, when a signal or the wall-time limit ended the run after a checkpoint,
    /// the reason. NumericalError when the run has to stop; report() then has the results so far.
    std::optional<std::string> run();

    /// Fills in steps, substeps, times, errors and stages so far.
    void report(io::Summary& summary, const std::vector<solver::Stage>& stages) const;

private:
    LoopCalls                  calls();
    std::optional<std::string> run_to_end();

    void begin_simulation();
    void start();
    void resume();
    void load_checkpoint();
    void write_checkpoint();
    void transfer(solver::StateFile& file);
    void require_same_world(solver::StateFile& file) const;

    std::optional<std::string> checkpoint_or_stop();
    void                       before_step(const solver::TimeStep& step);
    void                       after_step();
    void                       begin_phase();
    void                       end_phase();
    std::optional<PhaseEnd>    end_of_bed();
    void                       require_on_terrain(const DriveRoom& room, const Vec3<double>& axle) const;

    std::int64_t state_bytes() const;
    double       wall_time() const { return history_.wall + wall_clock() - wall_start_; }

    const Communicator&             communicator_;
    Log&                            log_;
    const scene::Scene&             scene_;
    world::World&                   world_;
    const std::vector<double>       body_measures_; ///< of the world with its rocks
    solver::Plan                    plan_;
    io::RunDirectory                directory_;
    solver::Simulation<Exec, Real>& simulation_;
    DriverOptions                   options_;
    std::vector<DriveRoom>          rooms_; ///< one for each driven body
    DriveWatch                      drive_watch_;
    TimeLoop<Exec, Real>            loop_;
    RunOutput<Exec, Real>           output_;
    Visits<Exec, Real>              visits_;
    double                          wall_start_ = 0;
    ProgressMessages                messages_{};
    RestartHistory                  history_;
    std::vector<io::PhaseReport>    ended_;
    std::optional<CheckpointClock>  checkpoint_clock_;
};

} // namespace tread::run
