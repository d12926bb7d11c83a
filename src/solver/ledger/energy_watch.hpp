#pragma once

#include <algorithm>
#include <cstdint>

#include "solver/ledger/sand_report.hpp"

namespace tread::solver
{

class StateFile;

/// Detects energy that appears in the sand without a source, which indicates too long a step. In an exact step the
/// work of stress on the grid equals the decrease of strain energy less the plastic work; any excess has appeared.
/// Velocities are known only half a step apart from stresses, and a transfer that filters strongly dissipates part of
/// that half step: energy counts as appeared only if it has both with and without that part. Sums decay at the rate
/// 1/memory per step.
class EnergyWatch
{
public:
    /// `mass` kg, `wave_speed` m/s. Energies below that of a strain of 1e-10 in all of the sand are ignored.
    EnergyWatch(double mass, double wave_speed);

    /// Adds a report whose steps took `dt` (s). The first call sets the reference.
    void add(const SandReport& sand, double dt);

    /// J, energy that appeared without a source.
    double appeared() const { return std::min(appeared_, appeared_ + transferred_); }

    /// J, largest energy of the sand plus the work of gravity and contacts.
    double scale() const { return held_ + received_; }

    /// Whether the state is wrong; true before the energy has doubled without a source.
    bool alarmed() const { return appeared() > tolerance * scale(); }

    /// Saves to a checkpoint, or loads from it.
    void transfer(StateFile& file);

    static constexpr double memory    = 1000; ///< steps
    static constexpr double tolerance = 0.5;

private:
    double floor_;
    double strain_    = -1; ///< J, after the last step; negative before the first
    double half_step_ = 0;  ///< J, half a step of SandReport::power() after the last step
    double appeared_ = 0, transferred_ = 0, held_ = 0, received_ = 0;
};

} // namespace tread::solver
