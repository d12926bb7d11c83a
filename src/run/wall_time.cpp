#include "run/wall_time.hpp"

#include <algorithm>
#include <thread>

#include <fmt/format.h>

#include "io/progress.hpp"

namespace tread::run
{

double wall_time(const Workload& work, const WorkCost& cost, int units)
{
    const double serial = cost.sand_steps * work.sand_steps + cost.searches * work.searches +
                          cost.substeps * work.substeps + cost.joint_substeps * work.joint_substeps +
                          cost.rows * work.rows;
    const double shared = cost.points * work.points + cost.yielding_points * work.yielding_points +
                          cost.pages * work.pages + cost.bodies * work.bodies +
                          cost.body_substeps * work.body_substeps + cost.near_substeps * work.near_substeps;
    return cost.start + serial + shared / units;
}

std::string duration_text(double seconds)
{
    constexpr double year = 365.25 * 86400;
    return seconds < year ? io::clock_text(seconds) : fmt::format("{:.2g} years", seconds / year);
}

int cores_here() { return static_cast<int>(std::max(1U, std::thread::hardware_concurrency())); }

} // namespace tread::run
