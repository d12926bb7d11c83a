#pragma once

#include <optional>
#include <string>

#include "solver/footing.hpp"
#include "solver/grid_error.hpp"
#include "solver/plan.hpp"

namespace tread::solver
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
Prediction predict(const Patch& patch, const World& world, const Plan& plan, const std::optional<DrivenWheel>& wheel);

/// Lines of `tread check` on a body: load, pressure, gap, bed, patch, cells, and the spacing of the next verdict.
std::string footing_lines(const scene::Scene& scene, const World& world, const Plan& plan, const Footing& footing);

} // namespace tread::solver
