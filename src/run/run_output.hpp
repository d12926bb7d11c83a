#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "io/provenance.hpp"
#include "io/run_directory.hpp"
#include "run/answers_so_far.hpp"
#include "run/axle_turn.hpp"
#include "run/recorder.hpp"
#include "run/snapshots.hpp"
#include "run/surface.hpp"
#include "run/time_loop.hpp"

namespace tread::run
{

/// Number of multiples of `every` (s; 0: none) up to `time`.
inline std::int64_t multiples(double time, double every)
{
    return every > 0 ? static_cast<std::int64_t>(std::floor((time + time_rounding) / every)) : 0;
}

/// Rows and snapshots that were due so far, and the steps at which the last ones were written.
struct OutputsDue
{
    std::int64_t rows          = 0;
    std::int64_t snapshots     = 0;
    std::int64_t last_row      = -1;
    std::int64_t last_snapshot = -1;
};

/// Constants of a run's output.
struct OutputPlace
{
    const Communicator& communicator;
    const scene::Scene& scene;
    const world::World& world;
    solver::Plan        plan;
    io::RunDirectory    directory;
    io::Provenance      provenance;
};

/// Writes what a run leaves while it runs: time series, snapshots and the bed. Collective; rank 0 writes what is not
/// written in parallel. EnvironmentError where a file cannot be written.
template<class Exec, class Real>
class RunOutput
{
public:
    /// `loop` must outlive this.
    RunOutput(const OutputPlace& place, TimeLoop<Exec, Real>& loop);

    /// Creates the time series.
    void begin();

    /// Records the beginning of a phase, and the surface on which its sinkage is based.
    void begin_phase();

    /// Writes a row and a snapshot of the present state.
    void write_row();
    void write_snapshot();

    /// Accounts for a step, and writes what is due: at the first step at or past each time.
    void after_step();

    /// Writes the last row and snapshot of a run, unless the last step has written them.
    void write_last();

    /// Writes the bed file; returns a line for the log.
    std::string write_bed();

    /// Waits for all snapshots.
    void finish_snapshots();

    /// Waits for all snapshots, and writes the rows that waited for them.
    void finish();

    /// Writes waiting rows as far as that is possible, when another file could not be written.
    void keep_rows() noexcept;

    /// Saves to a checkpoint, or loads from it; `checkpoint`: its path, for messages. Replaces nothing before all
    /// loaded data is checked.
    void transfer(solver::StateFile& file, const std::string& checkpoint);

    /// Continues at the loop's time, which transfer() may have loaded after this.
    void resume();

    /// Answers from the rows that this process has written.
    const AnswersSoFar& answers() const { return answers_; }

    /// Closes the time series.
    void close() { recorder_.reset(); }

private:
    std::vector<solver::BodyRow> wheel_rows();

    void flush_if_due();
    bool files_are_free();
    void write_due();
    void transfer_series(solver::StateFile& file, const std::string& checkpoint);
    void restore_series(const std::vector<std::uint8_t>& bytes, const std::string& checkpoint);

    OutputPlace                          place_;
    TimeLoop<Exec, Real>&                loop_;
    SurfaceMap                           surface_;   ///< reference for sinkage
    std::optional<Recorder>              recorder_;  ///< on rank 0
    std::optional<Snapshots<Exec, Real>> snapshots_; ///< only if the scene wants snapshots
    std::vector<AxleTurn>                turns_;     ///< of the named bodies
    OutputsDue                           due_;
    double                               last_flush_ = 0; ///< wall_clock()
    AnswersSoFar                         answers_;
};

} // namespace tread::run
