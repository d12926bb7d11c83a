#pragma once

#include <optional>
#include <vector>

#include "io/summary.hpp"
#include "run/grid_error.hpp"
#include "solver/ledger/extremes.hpp"
#include "solver/plan.hpp"
#include "world/world.hpp"

namespace tread::run
{

/// Figures that show how well a run is resolved: ledger, steps relative to the automatic ones, overlaps, contact
/// patch, distance fields. Figures of parts that the scene lacks are left out.
/// `wheel`: the scene's driven wheel (run/grid_error.hpp).
std::vector<io::Figure> figures(const solver::Extremes& extremes, const io::ErrorReport& errors,
                                const solver::PaceLimits& limits, const world::World& world, const solver::Plan& plan,
                                const std::optional<DrivenWheel>& wheel);

/// Bounds on contact_cells.
struct CellBounds
{
    double resolved;
    double marginal;
};

CellBounds cell_bounds(const solver::Plan& plan);

/// Points along a side of the contact patch of a named body (`patch_side`), from the mean number of touched points
/// over the time in contact; 0 = none.
double points_across(const solver::Extremes& extremes, const world::World& world);

/// Side of the same patch in cells of the grid.
double contact_cells(const solver::Extremes& extremes, const world::World& world);

} // namespace tread::run
