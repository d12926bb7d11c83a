#include "run/wall_time.hpp"

#include <algorithm>
#include <thread>

#include <fmt/format.h>

#include "io/progress.hpp"

namespace tread::run
{

double wall_time(const Estimate& wants, const world::World& world, const StepCost& cost, int units)
{
    const auto   points  = static_cast<double>(world.sand.size());
    const auto   bodies  = static_cast<double>(world.bodies.size());
    const double further = wants.substeps - 1;
    const double shared  = cost.point * points + (cost.body + cost.body_substep * further) * bodies;
    return wants.steps * (cost.step + cost.substep * further + shared / units);
}

std::string duration_text(double seconds)
{
    constexpr double year = 365.25 * 86400;
    return seconds < year ? io::clock_text(seconds) : fmt::format("{:.2g} years", seconds / year);
}

int cores_here() { return static_cast<int>(std::max(1U, std::thread::hardware_concurrency())); }

} // namespace tread::run
