#include "solver/ledger/sand_guard.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "base/errors.hpp"

namespace tread::solver
{

SandGuard::SandGuard(const PaceLimits& limits, double mass)
    : limits_(limits)
    , energy_(mass, limits.wave_speed)
{
}

void SandGuard::allow(const TimeStep& step, double time) const
{
    if (courant(step) > hopeless_courant) { fail("no sand is stable at this step", step, time); }
}

void SandGuard::check(const SandReport& sand, const TimeStep& step, double time) const
{
    if (sand.cell_change() == mpm::CellChange::not_finite)
    {
        fail("a point of the sand has a velocity or stress that is not a number", step, time);
    }
    if (sand.cell_change() == mpm::CellChange::lost && sand.steps > 1)
    {
        fail(fmt::format("a point of the sand has gone more than a cell in {} steps", sand.steps), step, time);
    }
    const double speed = sand.largest_speed;
    if (speed * step.dt > limits_.spacing)
    {
        fail(fmt::format("a point of the sand moves {:.3g} m/s, more than a cell a step", speed), step, time);
    }
}

void SandGuard::watch(const SandReport& sand, const TimeStep& step, double time)
{
    energy_.add(sand, step.dt);
    if (energy_.alarmed())
    {
        fail(fmt::format(
                 "the sand's energy grows without a source, by {:.3g} J in some {:.0f} steps in which it held and "
                 "received {:.3g} J",
                 energy_.appeared(), EnergyWatch::memory, energy_.scale()),
             step, time);
    }
}

void SandGuard::fail(const std::string& what, const TimeStep& step, double time) const
{
    throw NumericalError(
        fmt::format("t = {:.6g} s: {}; dt = {:.4g} s (limit: {}) is a Courant number c_p dt/h of {:.3g}, "
                    "automatic at most {:.3g}: take dt = \"auto\" or one under {:.3g} s",
                    time, what, step.dt, step.limit, courant(step), limits_.courant,
                    std::min(step.dt, limits_.courant * limits_.spacing / limits_.wave_speed)));
}

} // namespace tread::solver
