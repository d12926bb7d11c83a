#pragma once

#include <optional>
#include <string>

#include "run/grid_error.hpp"
#include "solver/plan.hpp"
#include "world/footing.hpp"

namespace tread::run
{

/// Predicted resolution verdict of the contact of a body at rest.
struct Prediction
{
    double      cells;   ///< contact_cells of the patch
    double      points;  ///< points across the patch
    io::Verdict verdict; ///< verdict on contact_cells, the grousers and the grid errors
    double      next; ///< m, largest spacing of the finest level with the next better verdict; the present one if it is
                      ///< resolved
};

/// `wheel`: the scene's driven wheel, if this body is that wheel.
Prediction predict(const world::Patch& patch, const world::World& world, const solver::Plan& plan,
                   const std::optional<DrivenWheel>& wheel);

/// Returns the lines of `tread check` on a body: load, pressure, gap, bed, patch, cells, and the spacing for the next
/// verdict.
std::string footing_lines(const scene::Scene& scene, const world::World& world, const solver::Plan& plan,
                          const world::Footing& footing);

} // namespace tread::run
