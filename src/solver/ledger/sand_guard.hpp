#pragma once

#include <string>

#include "solver/ledger/energy_watch.hpp"
#include "solver/time_step.hpp"

namespace tread::solver
{

/// Stops a run whose sand is unstable, before its energy has doubled without a source.
class SandGuard
{
public:
    /// `mass`: kg, of the sand.
    SandGuard(const PaceLimits& limits, double mass);

    /// Throws NumericalError, before the step, when no sand is stable at its length. `time` (s) is for the message.
    void allow(const TimeStep& step, double time) const;

    /// Throws NumericalError, with cause and limit, when a point's state is invalid. `sand`: report of the steps that
    /// end with `step`.
    void check(const SandReport& sand, const TimeStep& step, double time) const;

    /// Throws NumericalError when energy has grown without a source. Call once per report.
    void watch(const SandReport& sand, const TimeStep& step, double time);

    /// c_p dt/h at which sand is unstable at any number of points per cell (docs/theory.md#time-step: 0.82 at 1 a
    /// cell, 0.98 at 8). Loose sand may survive more; then its energy gives no indication.
    static constexpr double hopeless_courant = 1;

    /// Saves to a checkpoint, or loads from it.
    void transfer(StateFile& file) { energy_.transfer(file); }

private:
    [[noreturn]] void fail(const std::string& what, const TimeStep& step, double time) const;

    double courant(const TimeStep& step) const { return limits_.wave_speed * step.dt / limits_.spacing; }

    PaceLimits  limits_;
    EnergyWatch energy_;
};

} // namespace tread::solver
