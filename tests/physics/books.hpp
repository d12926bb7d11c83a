#pragma once

#include <algorithm>
#include <cmath>

#include "harness.hpp"

// The books of a run, looked at in every step.
namespace tread::test
{

inline constexpr double closes = 1e-3; ///< of the largest energy: design, section 7

/// Carries the scene to its end; the largest unaccounted share of the largest energy, which the books themselves hold
/// at any time.
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
