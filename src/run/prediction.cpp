#include "run/prediction.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "run/resolution_figures.hpp"

namespace tread::run
{
namespace
{

/// Bounds of the verdict's figures.
struct Bounds
{
    double cells;   ///< across the patch
    double error;   ///< error of pull, torque and sinkage
    double grouser; ///< cells over its height
    double gap;     ///< cells between two grousers
};

/// Largest grid spacing (m) that satisfies the bounds for a contact patch with sides `side` (m).
double coarsest(const Bounds& bounds, double side, const std::optional<DrivenWheel>& wheel)
{
    if (!wheel) { return side / bounds.cells; }
    const ErrorLaws& laws = wheel->laws;
    const double cells = std::max({bounds.cells, laws.pull.cells_for(bounds.error), laws.torque.cells_for(bounds.error),
                                   laws.sinkage.cells_for(bounds.error)});
    if (!wheel->grousers) { return side / cells; }
    return std::min({side / cells, wheel->grousers->height / bounds.grouser, wheel->grousers->gap / bounds.gap});
}

std::string prediction_lines(const world::Footing& footing, const world::World& world, const solver::Plan& plan,
                             const std::optional<DrivenWheel>& wheel)
{
    const world::Patch& patch = *footing.patch;
    const Prediction    seen  = predict(patch, world, plan, wheel);
    std::string text = fmt::format("  at rest, by bearing capacity or Hertz: sinkage {:.3g} m, patch {:.3g} x {:.3g} "
                                   "m, {:.3g} cells and {:.3g} points across\n",
                                   patch.sinkage, patch.length, patch.width, seen.cells, seen.points);
    if (const auto grousers = grouser_figures(wheel, world.geometry.finest_spacing()); !grousers.empty())
    {
        text += fmt::format("  grousers: {:.3g} cells high, {:.3g} cells from one to the next\n", grousers[0].value,
                            grousers[1].value);
    }
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

Prediction predict(const world::Patch& patch, const world::World& world, const solver::Plan& plan,
                   const std::optional<DrivenWheel>& wheel)
{
    const CellBounds bounds = cell_bounds(plan);
    const double     side   = world::patch_side(patch.area(), world);
    const double     finest = world.geometry.finest_spacing();
    const double     cells = side / finest, points = side / world.point_spacing;

    const double resolved = coarsest({bounds.resolved, resolved_error, resolved_grouser, resolved_gap}, side, wheel);
    const double marginal = coarsest({bounds.marginal, marginal_error, marginal_grouser, marginal_gap}, side, wheel);
    if (finest <= resolved) { return {cells, points, io::Verdict::resolved, finest}; }
    if (finest <= marginal) { return {cells, points, io::Verdict::marginal, resolved}; }
    return {cells, points, io::Verdict::under_resolved, marginal};
}

std::string footing_lines(const scene::Scene& scene, const world::World& world, const solver::Plan& plan,
                          const world::Footing& footing)
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

} // namespace tread::run
