#pragma once

#include <algorithm>
#include <cstdint>

#include "solver/sand_report.hpp"

namespace tread::solver
{

/// Watches for energy that appears in the sand without a source, the mark of a step that is too long. The stress of an
/// exact step does as much work on the grid as the strain energy falls by, less what plastic flow takes; what it does
/// beyond that has appeared. Velocities are known half a step away from stresses only, and a transfer that filters much
/// takes its part of that half step: energy has appeared if it has with and without that part. All is forgotten at the
/// rate of 1/memory a step.
class EnergyWatch
{
public:
    /// `mass` kg, `wave_speed` m/s: less energy than that of a strain of 1e-10 in all of the sand is none.
    EnergyWatch(double mass, double wave_speed);

    /// `dt`: s, of the report's steps. The first call sets the start.
    void add(const SandReport& sand, double dt);

    /// J, that appeared without a source.
    double appeared() const { return std::min(appeared_, appeared_ + transferred_); }

    /// J, what the sand held at most, and what gravity and contacts did.
    double scale() const { return held_ + received_; }

    /// True when the state is wrong: before its energy has doubled without a source.
    bool alarmed() const { return appeared() > tolerance * scale(); }

    static constexpr double memory    = 1000; ///< steps
    static constexpr double tolerance = 0.5;

private:
    double floor_;
    double strain_    = -1; ///< J, after the last step; negative before the first
    double half_step_ = 0;  ///< J, of SandReport::power() after it
    double appeared_ = 0, transferred_ = 0, held_ = 0, received_ = 0;
};

} // namespace tread::solver
