#include "run/grid_error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/contacts.hpp"
#include "scene/phase_settings.hpp"
#include "shape/template.hpp"

namespace tread::run
{
namespace
{

constexpr double least_friction_angle = 5; ///< degrees, least friction angle of frictional soils

ErrorLaw worse(const ErrorLaw& one, const ErrorLaw& other) { return one.factor >= other.factor ? one : other; }

ErrorLaws laws_on(SoilKind soil)
{
    ErrorLaws worst{{0, 1}, {0, 1}, {0, 1}};
    for (const MeasuredConvergence& row : measured_convergence)
    {
        if (row.soil != soil) { continue; }
        worst = {worse(worst.pull, row.laws.pull), worse(worst.torque, row.laws.torque),
                 worse(worst.sinkage, row.laws.sinkage)};
    }
    return worst;
}

/// Granular material of the terrain with most points; none: nullptr.
const scene::Material* soil_of(const scene::Scene& scene, const world::World& world)
{
    std::vector<std::size_t> points(scene.materials.size(), 0);
    for (const world::PointRow& row : world.sand.rows) { points[world.sand.kind_of(row).material] += row.count; }
    const scene::Material* soil = nullptr;
    std::size_t            most = 0;
    for (std::size_t m = 0; m < points.size(); ++m)
    {
        if (points[m] <= most || !scene::is_granular(scene.materials[m].model)) { continue; }
        most = points[m];
        soil = &scene.materials[m];
    }
    return soil;
}

std::optional<Grousers> grousers_of(const scene::Scene& scene, const world::World& world, std::size_t body)
{
    const scene::Shape shape = shape::find_shape(scene, scene.bodies[body].shape);
    const auto*        wheel = std::get_if<scene::WheelGenerator>(&shape.source);
    if (wheel == nullptr || wheel->grousers == 0 || !(wheel->grouser_height > 0)) { return std::nullopt; }
    const double drum  = wheel->radius - wheel->grouser_height;
    const double pitch = 2 * std::numbers::pi * drum / wheel->grousers;
    const double scale = world.bodies.scale[body];
    return Grousers{scale * wheel->grouser_height, scale * (pitch - wheel->grouser_width)};
}

} // namespace

double ErrorLaw::at(double cells) const { return factor / std::pow(cells, order); }

double ErrorLaw::cells_for(double error) const { return std::pow(factor / error, 1 / order); }

double share_of_friction(SoilKind soil, double friction)
{
    const FrictionShare* below = nullptr;
    for (const FrictionShare& row : friction_shares)
    {
        if (row.soil != soil) { continue; }
        if (friction <= row.friction)
        {
            if (below == nullptr) { return row.share; }
            const double between = (friction - below->friction) / (row.friction - below->friction);
            return below->share + between * (row.share - below->share);
        }
        below = &row;
    }
    return below->share;
}

std::optional<DrivenWheel> driven_wheel(const scene::Scene& scene, const world::World& world, const solver::Plan& plan)
{
    const scene::Material*     soil = plan.coupling ? soil_of(scene, world) : nullptr;
    std::optional<std::size_t> body;
    std::size_t                drive = 0;
    for (std::size_t p = 0; p < scene.phases.size(); ++p)
    {
        for (std::size_t b = 0; scene.phases[p].drive && b < scene.bodies.size(); ++b)
        {
            if (scene.bodies[b].name != scene.phases[p].drive->body) { continue; }
            body  = b;
            drive = p;
        }
    }
    if (soil == nullptr || !body) { return std::nullopt; }
    const auto&    wheel    = scene.materials[static_cast<std::size_t>(world.bodies.material[*body])];
    const double   friction = scene::contact_of(scene::contacts_in(scene, drive), wheel.family, soil->family).friction;
    const SoilKind kind = soil->friction_angle_deg < least_friction_angle ? SoilKind::cohesive : SoilKind::frictional;
    ErrorLaws      laws = laws_on(kind);
    laws.pull.factor *= share_of_friction(kind, friction);
    return DrivenWheel{world.bodies.mass[*body] * Vec3<double>(scene::gravity_in(scene, drive).data()).norm(), laws,
                       grousers_of(scene, world, *body)};
}

std::optional<io::GridError> grid_error(const std::optional<DrivenWheel>& wheel, double contact_cells)
{
    if (!wheel || contact_cells <= 0) { return std::nullopt; }
    const ErrorLaws& laws = wheel->laws;
    return io::GridError{wheel->load, laws.pull.at(contact_cells), laws.torque.at(contact_cells),
                         laws.sinkage.at(contact_cells)};
}

std::vector<io::Figure> grid_error_figures(const io::GridError& error)
{
    return {{"pull_error", error.pull, resolved_error, marginal_error},
            {"torque_error", error.torque, resolved_error, marginal_error},
            {"sinkage_error", error.sinkage, resolved_error, marginal_error}};
}

std::vector<io::Figure> grouser_figures(const std::optional<DrivenWheel>& wheel, double spacing)
{
    if (!wheel || !wheel->grousers) { return {}; }
    return {{"grouser_cells", wheel->grousers->height / spacing, resolved_grouser, marginal_grouser},
            {"grouser_gap_cells", wheel->grousers->gap / spacing, resolved_gap, marginal_gap}};
}

} // namespace tread::run
