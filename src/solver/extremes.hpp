#pragma once

#include <optional>
#include <vector>

#include "io/summary.hpp"
#include "kernels/contact/summary.hpp"
#include "solver/grid_error.hpp"
#include "solver/plan.hpp"
#include "solver/time_step.hpp"
#include "solver/world.hpp"

namespace tread::solver
{

/// What each measuring of a run sees anyway, at its worst so far. Doubles and nothing else: a checkpoint has them.
struct Extremes
{
    double courant       = 0; ///< c_p dt/h
    double travel        = 0; ///< v dt/h
    double spring        = 0; ///< k dt^2/m_p of the stiffest sand-body contact
    double substep       = 0; ///< over sqrt(m / sum K) of the stiffest body
    double body_overlap  = 0; ///< over the smaller radius
    double point_overlap = 0; ///< over the point's radius
    double touched       = 0; ///< s, in which named bodies touched sand
    double touching      = 0; ///< s, times the points that they touched

    /// `steps` steps that end with `step`, which `pace` was measured after.
    void note(const TimeStep& step, std::int64_t steps, const PaceLimits& limits, const Pace& pace,
              const contact::Summary& contacts);
};

/// What is known of how well a run is resolved: its books, its steps against the automatic ones, overlaps, the contact
/// patch, the distance fields. A figure that the scene has no part for is left out.
/// `wheel`: of the scene (solver/grid_error.hpp).
std::vector<io::Figure> figures(const Extremes& extremes, const io::ErrorReport& errors, const PaceLimits& limits,
                                const World& world, const Plan& plan, const std::optional<DrivenWheel>& wheel);

/// Bounds of contact_cells.
struct CellBounds
{
    double resolved;
    double marginal;
};

CellBounds cell_bounds(const Plan& plan);

/// Points along a side of the contact patch of a named body (`patch_side`), from the mean number of touched points over
/// the time in contact; 0 = none.
double points_across(const Extremes& extremes, const World& world);

/// The same in cells of the grid.
double contact_cells(const Extremes& extremes, const World& world);

} // namespace tread::solver
