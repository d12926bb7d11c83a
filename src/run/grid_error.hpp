#pragma once

#include <array>
#include <optional>
#include <vector>

#include "io/grid_error.hpp"
#include "io/resolution.hpp"
#include "solver/plan.hpp"
#include "world/world.hpp"

// Discretisation error of a driven wheel's answers, from measured grid convergence.
namespace tread::run
{

/// error = factor / cells^order, where cells is the run's `contact_cells`.
struct ErrorLaw
{
    double factor;
    double order;

    double at(double cells) const;
    double cells_for(double error) const; ///< least number of cells at which the error is at most that
};

/// Error laws of a driven wheel's answers: pull over the load, torque and sinkage relative.
struct ErrorLaws
{
    ErrorLaw pull;
    ErrorLaw torque;
    ErrorLaw sinkage;
};

enum class SoilKind
{
    frictional,
    cohesive ///< friction angle under 5 degrees
};

/// One measured convergence series.
struct MeasuredConvergence
{
    const char* scene;
    SoilKind    soil;
    ErrorLaws   laws;
};

/// Convergence of driven drums of radius 0.245 m and width 0.2 m under 1000 N at slip 0.4 with a friction of 0.8
/// between wheel and soil, at spacings of 20, 12.5, (10,) 7.5 and 5 mm (grousers and clay: without 5): least-squares
/// fits of answer = limit + slope / cells^order. Answers and scenes are in docs/verdict.md;
/// `postprocess/grid_error.py` prints these rows from runs.
inline constexpr std::array<MeasuredConvergence, 3> measured_convergence = {{
    {"smooth drum on sand", SoilKind::frictional, {{2.0, 1}, {7.6, 2}, {2.9, 1}}},
    {"drum with 24 grousers on sand", SoilKind::frictional, {{1.3, 1}, {7.1, 2}, {2.0, 1}}},
    {"smooth drum on clay", SoilKind::cohesive, {{1.8, 1}, {26, 2}, {0.94, 1}}},
}};

/// Slope of the pull over the spacing at a friction between wheel and soil, relative to that at 0.8.
struct FrictionShare
{
    SoilKind soil;
    double   friction;
    double   share;
};

/// Measured in plane strain (5000 N a metre of width), spacings of 20 to 7.5 mm; magnitudes.
inline constexpr std::array<FrictionShare, 7> friction_shares = {{
    {SoilKind::frictional, 0.4, 0.22},
    {SoilKind::frictional, 0.6, 0.74},
    {SoilKind::frictional, 0.8, 1.0},
    {SoilKind::cohesive, 0.0, 0.14},
    {SoilKind::cohesive, 0.1, 0.30},
    {SoilKind::cohesive, 0.3, 0.60},
    {SoilKind::cohesive, 0.8, 1.0},
}};

/// Interpolates the share linearly; constant beyond the measured frictions.
double share_of_friction(SoilKind soil, double friction);

/// Grousers of a generated wheel at its size in the scene, m.
struct Grousers
{
    double height;
    double gap; ///< between two of them, at their feet
};

/// The last driven wheel of a scene on granular sand.
struct DrivenWheel
{
    double                  load; ///< N
    ErrorLaws               laws;
    std::optional<Grousers> grousers = std::nullopt; ///< none, or unknown for a mesh
};

/// Laws for the last wheel that the scene drives: for each answer the largest factor measured on its kind of soil.
/// Empty for scenes without a driven wheel or on elastic ground, where no convergence was measured.
std::optional<DrivenWheel> driven_wheel(const scene::Scene& scene, const world::World& world, const solver::Plan& plan);

/// Grid error; empty without a driven wheel, or if none touched sand (contact_cells = 0).
std::optional<io::GridError> grid_error(const std::optional<DrivenWheel>& wheel, double contact_cells);

/// Figures pull_error, torque_error and sinkage_error of the verdict.
std::vector<io::Figure> grid_error_figures(const io::GridError& error);

/// Figures grouser_cells and grouser_gap_cells of the verdict: height of grousers and gap between them in cells of
/// `spacing` (m). Empty without grousers.
std::vector<io::Figure> grouser_figures(const std::optional<DrivenWheel>& wheel, double spacing);

/// Bounds of grouser_cells and grouser_gap_cells, from what grousers add to the pull of the drum on sand. 24 of them,
/// 20 or 30 mm high and 10 or 4 mm wide, add nothing with gaps of 2.3 to 2.7 cells, and with 3.7 to 4.4 cells as much
/// as with smaller cells (docs/verdict.md).
inline constexpr double resolved_grouser = 2.5;
inline constexpr double marginal_grouser = 1.5;
inline constexpr double resolved_gap     = 3.5;
inline constexpr double marginal_gap     = 2.75;

/// Bounds of all three figures.
inline constexpr double resolved_error = 0.05;
inline constexpr double marginal_error = 0.2;

} // namespace tread::run
