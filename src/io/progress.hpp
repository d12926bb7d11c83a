#pragma once

#include <cstdint>
#include <optional>
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

    std::optional<double> pull    = {}; ///< N, mean so far
    std::optional<double> sinkage = {}; ///< m
};

/// Log line, such as "drive  t 1.2 / 3.6 s  24000 steps  812 steps/s  ETA 0:04:12  dt 5.00e-05 s (elastic wave)  pull
/// 57 N  sinkage 0.049 m".
std::string progress_line(const Progress& progress);

/// Status for a terminal, "[######--------------] 33 %  drive  t 1.2 / 3.6 s  ETA 0:04:12  pull 57 N ...". What comes
/// last is left out where it does not fit into `columns`.
std::string status_line(const Progress& progress, int columns);

/// Formats seconds as "h:mm:ss".
std::string clock_text(double seconds);

/// Lists stages that ran, longest first, with calls, seconds and share of the wall time, then the remaining wall time,
/// or the excess of stages that are timed one by one, then "left out: stage - why" for each that the scene does not
/// need. Lines end with a newline.
std::string timing_table(const std::vector<StageReport>& stages, double wall_s);

} // namespace tread::io
