#include "solver/prediction.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "solver/extremes.hpp"

namespace tread::solver
{
namespace
{

/// Cells across the patch from which on contact_cells and the grid errors keep their bounds.
double cells_needed(double bound, double error, const std::optional<DrivenWheel>& wheel)
{
    if (!wheel) { return bound; }
    const ErrorLaws& laws = wheel->laws;
    return std::max({bound, laws.pull.cells_for(error), laws.torque.cells_for(error), laws.sinkage.cells_for(error)});
}

std::string prediction_lines(const Footing& footing, const World& world, const Plan& plan,
                             const std::optional<DrivenWheel>& wheel)
{
    const Patch&     patch = *footing.patch;
    const Prediction seen  = predict(patch, world, plan, wheel);
    std::string text = fmt::format("  at rest, by bearing capacity or Hertz: sinkage {:.3g} m, patch {:.3g} x {:.3g} "
                                   "m, {:.3g} cells and {:.3g} points across\n",
                                   patch.sinkage, patch.length, patch.width, seen.cells, seen.points);
    if (const auto error = grid_error(wheel, seen.cells))
    {
        text += fmt::format("  grid error: {}\n", io::grid_error_line(*error, std::nullopt));
    }
    text += fmt::format("  resolution of the contact: {}", io::name_of(seen.verdict));
    if (seen.verdict == io::Verdict::resolved) { return text + "\n"; }
    const auto   better   = seen.verdict == io::Verdict::marginal ? io::Verdict::resolved : io::Verdict::marginal;
    const double coarsest = seen.next * world.geometry.spacing / world.geometry.finest_spacing();
    return text + fmt::format("; {} from grid.spacing = {:.3g} m\n", io::name_of(better), coarsest);
}

} // namespace

Prediction predict(const Patch& patch, const World& world, const Plan& plan, const std::optional<DrivenWheel>& wheel)
{
    const CellBounds bounds   = cell_bounds(plan);
    const double     resolved = cells_needed(bounds.resolved, resolved_error, wheel);
    const double     marginal = cells_needed(bounds.marginal, marginal_error, wheel);
    const double     side     = patch_side(patch.area(), world);
    const double     finest   = world.geometry.finest_spacing();
    const double     cells    = side / finest;
    const double     points   = side / world.point_spacing;
    if (cells >= resolved) { return {cells, points, io::Verdict::resolved, finest}; }
    if (cells >= marginal) { return {cells, points, io::Verdict::marginal, side / resolved}; }
    return {cells, points, io::Verdict::under_resolved, side / marginal};
}

std::string footing_lines(const scene::Scene& scene, const World& world, const Plan& plan, const Footing& footing)
{
    std::string text = fmt::format("{}: weight {:.4g} N", scene.bodies[footing.body].name, footing.load);
    if (footing.patch && footing.patch->carried)
    {
        text += fmt::format(", {:.3g} kPa on its contact patch", 1e-3 * footing.load / footing.patch->area());
    }
    if (footing.gap) { text += fmt::format(", {:.3g} m above the ground", *footing.gap); }
    if (footing.ground)
    {
        text += fmt::format(", bed {:.3g} m deep under it and {:.3g} m wide beside it", footing.ground->depth,
                            footing.ground->beside);
    }
    text += "\n";
    if (!footing.patch) { return text; }
    const bool counts = footing.driven;
    return text + prediction_lines(footing, world, plan, counts ? driven_wheel(scene, world, plan) : std::nullopt);
}

} // namespace tread::solver
