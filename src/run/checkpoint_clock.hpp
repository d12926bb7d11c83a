#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/communicator.hpp"
#include "scene/scene.hpp"

namespace tread::run
{

/// s, of a clock that never goes back.
double wall_clock();

/// What a run is to do after a step.
struct Interruption
{
    bool        write = false; ///< a checkpoint
    bool        stop  = false; ///< after it
    std::string why;           ///< of a stop
};

/// Says when the state is to be written and when a run has to end: by what the scene wants, by signals
/// (base/signals.hpp) to any rank, and by a limit on wall time, before which it leaves what a checkpoint takes twice
/// over.
class CheckpointClock
{
public:
    /// `limit`: s of wall time since `start`, a wall_clock(); 0 = none. `time` (s) and `step` are those of the state
    /// that the run begins with.
    CheckpointClock(const scene::CheckpointOptions& options, double limit, double start, double time,
                    std::int64_t step);

    /// Collective, the same on all ranks; rank 0's clock counts.
    Interruption look(const Communicator& communicator, double time, std::int64_t step);

    /// Within a step: why the run has to stop at once, if it has to. Collective, the same on all ranks.
    std::optional<std::string> look_within_step(const Communicator& communicator) const;

    /// A checkpoint was written, which took so many seconds.
    void written(double time, std::int64_t step, double seconds);

    /// s, until one was written: what `bytes` take at a modest disk's 100 MB/s.
    void expect(std::int64_t bytes) { cost_ = static_cast<double>(bytes) / 1e8; }

private:
    scene::CheckpointOptions options_;
    double                   end_;          ///< wall_clock(); infinite without a limit
    double                   cost_    = 0;  ///< s, of a checkpoint
    double                   slowest_ = 0;  ///< s, between two looks
    double                   last_look_;    ///< wall_clock()
    double                   last_written_; ///< wall_clock(), or of the start
    double                   last_time_;    ///< s simulated, of the last checkpoint, or of the start
    std::int64_t             last_step_;
};

} // namespace tread::run
