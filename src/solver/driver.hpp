#pragma once

#include "base/log.hpp"
#include "base/watchdog.hpp"
#include "io/run_directory.hpp"
#include "io/summary.hpp"
#include "solver/simulation.hpp"

namespace tread::solver
{

/// Carries a simulation through the phases of its scene, and writes what the scene asks for. Collective: all ranks take
/// the same steps; rank 0 writes what is not written together.
template<class Exec, class Real>
class Driver
{
public:
    Driver(const Communicator& communicator, Log& log, const scene::Scene& scene, const World& world,
           const io::RunDirectory& directory, const Plan& plan, Simulation<Exec, Real>& simulation);

    /// All phases. NumericalError when the run has to stop; what happened until then is in report().
    void run();

    /// Steps, substeps, times, errors and stages so far.
    void report(io::Summary& summary, const std::vector<Stage>& stages) const;

private:
    void   begin_phase();
    void   end_phase();
    void   advance();
    void   write_due();
    void   write_row();
    void   write_snapshot();
    void   write_bed();
    void   say_progress();
    void   warn_once(const TimeStep& step);
    double end_time() const;

    const Communicator&               communicator_;
    Log&                              log_;
    const scene::Scene&               scene_;
    const World&                      world_;
    Plan                              plan_;
    io::RunDirectory                  directory_;
    Simulation<Exec, Real>&           simulation_;
    PhaseClock                        phases_;
    std::optional<Recorder>           recorder_;  ///< on rank 0
    std::optional<io::SnapshotWriter> snapshots_; ///< only if the scene wants snapshots
    std::optional<Watchdog>           watchdog_;  ///< on several ranks
    StageClock                        clock_;
    std::vector<io::PhaseReport>      ended_;
    TimeStep                          step_;
    double                            time_          = 0;
    std::int64_t                      steps_         = 0;
    std::int64_t                      substeps_      = 0;
    std::int64_t                      rows_          = 0; ///< time-series rows that were due so far
    std::int64_t                      snapshots_due_ = 0;
    bool                              warned_        = false;
    double                            wall_start_;
    double                            last_said_;
};

} // namespace tread::solver
