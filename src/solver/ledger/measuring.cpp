#include "solver/ledger/measuring.hpp"

#include <algorithm>

#include "solver/state_file.hpp"

namespace tread::solver
{
namespace
{

constexpr double unmeasured_displacement = 0.5; ///< displacement of sand, in spacings, after which it is measured again
constexpr double largest_speed           = 1e7; ///< m/s: steps with a larger one would not end

} // namespace

std::int64_t steps_until_measured(const TimeStep& step, const PaceLimits& limits, const Pace& pace, double spacing)
{
    if (over_limit(step, limits, pace)) { return 1; }
    const double displacement = pace.largest_speed * step.dt;
    return static_cast<std::int64_t>(
        std::clamp(unmeasured_displacement * spacing / displacement, 1.0, static_cast<double>(Measuring::most_steps)));
}

void transfer(StateFile& file, Measuring& measuring, LastStep& last, double& damping)
{
    Pace& pace = measuring.pace;
    file.numbers("simulation/pace", accept::number(pace.largest_speed, 0, largest_speed),
                 accept::number(pace.sand_speed, 0, largest_speed),
                 accept::number(pace.stiffest_point, 0, accept::largest),
                 accept::number(pace.shortest_contact, 0, accept::largest), pace.overlap);
    measuring.extremes.transfer(file);
    file.numbers("simulation/steps", measuring.unbalanced, damping, accept::number(last.step.dt, 0, accept::largest),
                 last.step.substeps, last.time, accept::number(measuring.every, 1, Measuring::most_steps));
}

} // namespace tread::solver
