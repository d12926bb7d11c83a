#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/summary.hpp"

namespace tread::io
{

/// Progress of a run.
struct Progress
{
    std::string  phase;
    double       time        = 0; ///< s simulated
    double       end_time    = 0; ///< s, at most
    std::int64_t steps       = 0;
    double       steps_per_s = 0; ///< of wall time, recent
    double       time_per_s  = 0; ///< s simulated per second of wall time, recent
    double       dt          = 0; ///< s
    std::string  limit;           ///< what limits dt: "elastic wave"
};

/// Log line, such as "drive  t 1.20 / 3.60 s  24000 steps  812 steps/s  ETA 0:04:12  dt 5.0e-05 s (elastic wave)".
std::string progress_line(const Progress& progress);

/// Formats seconds as "h:mm:ss".
std::string clock_text(double seconds);

/// Lists stages that ran, longest first, with calls, seconds and share of the wall time, then the remaining wall time,
/// or the excess of stages that are timed one by one, then "left out: stage - why" for each that the scene does not
/// need. Lines end with a newline.
std::string timing_table(const std::vector<StageReport>& stages, double wall_s);

} // namespace tread::io
