#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "backend/backends.hpp"
#include "backend/memory.hpp"
#include "io/summary.hpp"
#include "solver/plan.hpp"

namespace tread::solver
{

class StateFile;

/// Measures wall time by stage. On a GPU it synchronises at a stage's end in one step of seventeen only, so that
/// timing opens no gaps between launches, and scales the seconds of the timed calls. Each part of a restarted run is
/// scaled separately, since parts may run on other machines.
class StageClock
{
public:
    void begin_step(std::int64_t step) { step_ = step; }

    template<class Exec, class F>
    void run(const Exec& exec, const char* name, F f)
    {
        Row& row = rows_[name];
        ++row.calls;
        if (!sampled(exec))
        {
            f();
            return;
        }
        synchronize(exec);
        const auto start = std::chrono::steady_clock::now();
        f();
        synchronize(exec);
        row.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        ++row.timed;
    }

    /// Times a stage that synchronises by itself and is too rare to be sampled.
    template<class F>
    void run_timed(const char* name, F f)
    {
        Row&       row   = rows_[name];
        const auto start = std::chrono::steady_clock::now();
        f();
        row.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        ++row.calls;
        ++row.timed;
    }

    /// Saves or loads the times of this run and of the runs that it continues.
    void transfer(StateFile& file);

    /// Reports the plan's stages with calls and seconds.
    std::vector<io::StageReport> reports(const std::vector<Stage>& stages) const;

private:
    struct Part
    {
        std::int64_t calls   = 0;
        std::int64_t timed   = 0;
        double       seconds = 0; ///< time of the timed calls

        double scaled() const
        {
            return timed > 0 ? seconds * static_cast<double>(calls) / static_cast<double>(timed) : 0;
        }
    };

    struct Row : Part
    {
        Part before; ///< times of the runs that this one continues

        std::int64_t all_calls() const { return before.calls + calls; }
        double       all_seconds() const { return before.scaled() + scaled(); }
    };

    static constexpr std::int64_t gpu_sample = 17; ///< steps; not a multiple of the number of steps between two reports

    /// Whether stages of this step are timed.
    template<class Exec>
    bool sampled(const Exec&) const
    {
        return !is_gpu<Exec> || step_ % gpu_sample == 0;
    }

    std::int64_t                            step_ = 0;
    std::map<std::string, Row, std::less<>> rows_;
};

} // namespace tread::solver
