#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "run/phases.hpp"
#include "solver/bodies/body_row.hpp"

namespace tread::run
{

/// Pull and sinkage of the body that the running phase drives or lowers, for messages; a checkpoint does not hold them.
/// Both follow the definitions of the answers (docs/output.md), but for the transient, which stays in.
struct AnswersSoFar
{
    /// Adds a row of the time series; `time` in s.
    void add(const scene::Scene& scene, const RunningPhase& running, double time,
             const std::vector<solver::BodyRow>& bodies);

    /// Mean over the rows since the drive's ramp, N; empty before the first.
    std::optional<double> pull() const;

    std::size_t           phase    = 0;
    double                last_row = 0;  ///< s
    double                span     = 0;  ///< s, of the rows that count
    double                impulse  = 0;  ///< N s, pull over that span
    std::optional<double> sinkage  = {}; ///< m, of the last row
};

} // namespace tread::run
