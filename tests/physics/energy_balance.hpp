#pragma once

#include <algorithm>
#include <cmath>

#include "harness.hpp"

// Checks the energy balance of a run in every step.
namespace tread::test
{

inline constexpr double closes = 1e-3; ///< of the largest energy: design, section 7

/// Runs a scene to its end; returns the largest unaccounted share of the largest energy, as the ledger computes it.
template<class Exec>
double largest_unaccounted(Experiment<Exec>& run)
{
    double worst = 0;
    run.run(
        [&](double)
        {
            solver::Ledger& ledger = run.simulation().ledger();
            ledger.energy(run.simulation().census());
            worst = std::max(worst, std::abs(ledger.errors().energy));
        });
    return worst;
}

} // namespace tread::test
