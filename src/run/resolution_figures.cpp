#include "run/resolution_figures.hpp"

#include <algorithm>
#include <cmath>

namespace tread::run
{
namespace
{

/// Automatic step over the step taken: 1 for automatic steps, less where steps are longer.
double margin(double automatic, double taken) { return taken > 0 ? automatic / taken : 1e9; }

void add_ledger_errors(std::vector<io::Figure>& figures, const io::ErrorReport& errors)
{
    figures.push_back({"mass_error", errors.mass, 1e-6, 1e-3});
    figures.push_back({"momentum_error", errors.momentum, 1e-4, 1e-2});
    figures.push_back({"energy_error", std::abs(errors.energy), 0.01, 0.05});
}

void add_sand(std::vector<io::Figure>& figures, const solver::Extremes& extremes, const io::ErrorReport& errors,
              const solver::PaceLimits& limits)
{
    figures.push_back({"transfer_loss", std::abs(errors.transfer), 0.02, 0.1});
    figures.push_back({"margin_wave", margin(limits.courant, extremes.courant), 0.999, 0.8});
    figures.push_back({"margin_travel", margin(solver::displacement_bound, extremes.displacement), 0.6, 0.3});
}

void add_contact_with_sand(std::vector<io::Figure>& figures, const solver::Extremes& extremes,
                           const io::ErrorReport& errors, const world::World& world, const solver::Plan& plan)
{
    figures.push_back({"coupling_error", std::abs(errors.coupling), 0.01, 0.05});
    figures.push_back(
        {"margin_sand_contact", std::sqrt(margin(solver::point_contact_bound, extremes.spring)), 0.7, 0.5});
    figures.push_back({"point_overlap", extremes.point_overlap, 1, 2});
    const double cells = contact_cells(extremes, world);
    if (cells == 0) { return; }
    const CellBounds bounds = cell_bounds(plan);
    figures.push_back({"contact_cells", cells, bounds.resolved, bounds.marginal});
}

void add_bodies(std::vector<io::Figure>& figures, const solver::Extremes& extremes, const world::World& world)
{
    if (extremes.substep > 0)
    {
        figures.push_back(
            {"margin_body_contact", margin(scene::TimeOptions{}.contact_share, extremes.substep), 0.5, 0.25});
    }
    figures.push_back({"body_overlap", extremes.body_overlap, 0.1, 0.3});
    double off = 0;
    for (const auto& form : world.templates) { off = std::max(off, std::abs(form.sdf_volume_ratio - 1)); }
    figures.push_back({"field_volume_error", off, 0.02, 0.1});
}

} // namespace

double points_across(const solver::Extremes& extremes, const world::World& world)
{
    if (extremes.touched == 0) { return 0; }
    const double points  = extremes.touching / extremes.touched / static_cast<double>(world.bodies.named);
    const double spacing = world.point_spacing;
    return world::patch_side(points * spacing * spacing, world) / spacing;
}

double contact_cells(const solver::Extremes& extremes, const world::World& world)
{
    return points_across(extremes, world) * world.point_spacing / world.geometry.finest_spacing();
}

CellBounds cell_bounds(const solver::Plan& plan) { return plan.plasticity ? CellBounds{20, 6} : CellBounds{4, 2}; }

std::vector<io::Figure> figures(const solver::Extremes& extremes, const io::ErrorReport& errors,
                                const solver::PaceLimits& limits, const world::World& world, const solver::Plan& plan,
                                const std::optional<DrivenWheel>& wheel)
{
    std::vector<io::Figure> figures;
    add_ledger_errors(figures, errors);
    if (plan.sand) { add_sand(figures, extremes, errors, limits); }
    if (plan.coupling) { add_contact_with_sand(figures, extremes, errors, world, plan); }
    if (plan.bodies) { add_bodies(figures, extremes, world); }
    if (plan.mass_scaling) { figures.push_back({"mass_scaling", std::abs(errors.mass_scaling), 0.01, 0.05}); }
    if (!plan.coupling) { return figures; }
    for (const io::Figure& figure : grouser_figures(wheel, world.geometry.finest_spacing()))
    {
        figures.push_back(figure);
    }
    if (const auto error = grid_error(wheel, contact_cells(extremes, world)))
    {
        for (const io::Figure& figure : grid_error_figures(*error)) { figures.push_back(figure); }
    }
    return figures;
}

} // namespace tread::run
