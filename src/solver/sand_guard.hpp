#pragma once

#include <string>

#include "solver/energy_watch.hpp"
#include "solver/state_file.hpp"
#include "solver/time_step.hpp"

namespace tread::solver
{

/// Stops a run whose sand is unstable, before its energy has doubled without a source.
class SandGuard
{
public:
    /// `mass` kg, of the sand.
    SandGuard(const PaceLimits& limits, double mass);

    /// NumericalError when no sand is stable at such a step, before it does harm. `time` (s) is for the message.
    void allow(const TimeStep& step, double time) const;

    /// `sand`: what the steps that end with `step` did. NumericalError, with what and which limit, when a point's state
    /// is none.
    void check(const SandReport& sand, const TimeStep& step, double time) const;

    /// NumericalError when energy has grown without a source. Once a report.
    void watch(const SandReport& sand, const TimeStep& step, double time);

    /// c_p dt/h from which on sand was destroyed whatever its points a cell (docs/theory.md#time-step: 0.82 at 1 a
    /// cell, 0.98 at 8). Where a scene is loose enough to live with more, its energy tells nothing.
    static constexpr double hopeless_courant = 1;

    /// Into a checkpoint, or out of it.
    void transfer(StateFile& file) { file.doubles("sand/energy_watch", energy_); }

private:
    [[noreturn]] void fail(const std::string& what, const TimeStep& step, double time) const;

    double courant(const TimeStep& step) const { return limits_.wave_speed * step.dt / limits_.spacing; }

    PaceLimits  limits_;
    EnergyWatch energy_;
};

} // namespace tread::solver
