#pragma once

#include <optional>
#include <string>

#include "run/grid_error.hpp"
#include "solver/plan.hpp"
#include "world/footing.hpp"

namespace tread::run
{

/// What the verdict will say of the contact of a body at rest, before the run.
struct Prediction
{
    double      cells;   ///< contact_cells of the patch
    double      points;  ///< across the patch
    io::Verdict verdict; ///< of contact_cells, grouser_cells and the grid errors
    double      next;    ///< m, finest spacing at which it is one better; the present one if it is resolved
};

/// `wheel`: of the scene, if this body is the one that it is about.
Prediction predict(const world::Patch& patch, const world::World& world, const solver::Plan& plan,
                   const std::optional<DrivenWheel>& wheel);

/// Lines of `tread check` on a body: load, pressure, gap, bed, patch, cells, and the spacing of the next verdict.
std::string footing_lines(const scene::Scene& scene, const world::World& world, const solver::Plan& plan,
                          const world::Footing& footing);

} // namespace tread::run
