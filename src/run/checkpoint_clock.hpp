#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "base/communicator.hpp"
#include "scene/scene.hpp"

namespace tread::run
{

/// s, of a monotonic clock.
double wall_clock();

/// Action of a run after a step.
struct Interruption
{
    bool        write = false; ///< write a checkpoint
    bool        stop  = false; ///< stop after it
    std::string why;           ///< reason for the stop
};

/// Decides when to write a checkpoint and when a run must end: by the scene's options, by signals (base/signals.hpp)
/// to any rank, by a further source, and by a limit on wall time, before which it reserves twice the time of a
/// checkpoint.
class CheckpointClock
{
public:
    /// `limit`: s of wall time since `start` (a wall_clock() value); 0 = none. `time` (s) and `step` are those of the
    /// initial state.
    CheckpointClock(const scene::CheckpointOptions& options, double limit, double start, double time,
                    std::int64_t step);

    /// Sets a further source of requests to stop, of this rank; empty: none.
    void set_stop_source(std::function<bool()> stop_asked) { stop_asked_ = std::move(stop_asked); }

    /// Collective: the same result on all ranks; rank 0's clock decides.
    Interruption check(const Communicator& communicator, double time, std::int64_t step);

    /// Checks within a step whether the run must stop at once, and why. Collective: the same result on all ranks.
    std::optional<std::string> check_within_step(const Communicator& communicator) const;

    /// Records that a checkpoint was written, and how long it took.
    void written(double time, std::int64_t step, double seconds);

    /// Estimates the time (s) of the first checkpoint: `bytes` at a modest disk's 100 MB/s.
    void expect(std::int64_t bytes) { cost_ = static_cast<double>(bytes) / 1e8; }

private:
    scene::CheckpointOptions options_;
    double                   end_;          ///< wall_clock(); infinite without a limit
    double                   cost_    = 0;  ///< s, time to write a checkpoint
    double                   slowest_ = 0;  ///< s, longest time between two checks
    double                   last_check_;   ///< wall_clock()
    double                   last_written_; ///< wall_clock() of the last checkpoint, or of the start
    double                   last_time_;    ///< s simulated, at the last checkpoint, or at the start
    std::int64_t             last_step_;
    std::function<bool()>    stop_asked_;
};

} // namespace tread::run
