#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/summary.hpp"

namespace tread::io
{

/// Where a run stands.
struct Progress
{
    std::string  phase;
    double       time        = 0; ///< s simulated
    double       end_time    = 0; ///< s, at most
    std::int64_t steps       = 0;
    double       steps_per_s = 0; ///< of wall time, of late
    double       time_per_s  = 0; ///< s simulated in a second of wall time, of late
    double       dt          = 0; ///< s
    std::string  limit;           ///< what holds dt down: "elastic wave"
};

/// "drive  t 1.20 / 3.60 s  24000 steps  812 steps/s  ETA 0:04:12  dt 5.0e-05 s (elastic wave)".
std::string progress_line(const Progress& progress);

/// "h:mm:ss".
std::string clock_text(double seconds);

/// Stages that ran, longest first, with calls, seconds and share of the wall time, then the rest of the wall time or by
/// how much stages that are timed one by one take more, then "left out: stage - why" for each that the scene has no
/// need of. Lines end with a newline.
std::string timing_table(const std::vector<StageReport>& stages, double wall_s);

} // namespace tread::io
