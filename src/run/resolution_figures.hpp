#pragma once

#include <optional>
#include <vector>

#include "io/summary.hpp"
#include "run/grid_error.hpp"
#include "solver/extremes.hpp"
#include "solver/plan.hpp"
#include "world/world.hpp"

namespace tread::run
{

/// What is known of how well a run is resolved: its books, its steps against the automatic ones, overlaps, the contact
/// patch, the distance fields. A figure that the scene has no part for is left out.
/// `wheel`: of the scene (run/grid_error.hpp).
std::vector<io::Figure> figures(const solver::Extremes& extremes, const io::ErrorReport& errors,
                                const solver::PaceLimits& limits, const world::World& world, const solver::Plan& plan,
                                const std::optional<DrivenWheel>& wheel);

/// Bounds of contact_cells.
struct CellBounds
{
    double resolved;
    double marginal;
};

CellBounds cell_bounds(const solver::Plan& plan);

/// Points along a side of the contact patch of a named body (`patch_side`), from the mean number of touched points over
/// the time in contact; 0 = none.
double points_across(const solver::Extremes& extremes, const world::World& world);

/// The same in cells of the grid.
double contact_cells(const solver::Extremes& extremes, const world::World& world);

} // namespace tread::run
