#include "solver/plan.hpp"

#include <algorithm>

#include "scene/phase_settings.hpp"

namespace tread::solver
{

Plan make_plan(const scene::Scene& scene, const world::World& world, int ranks)
{
    const auto plastic = [](const scene::Material& material) { return scene::is_granular(material.model); };
    const auto capped  = [](const scene::Material& material)
    { return material.model == scene::MaterialModel::drucker_prager_cap; };
    const auto damped = [](const scene::Phase& phase) { return phase.damping > 0; };
    const auto moved  = [](const scene::Phase& phase) { return !phase.motion.empty(); };
    Plan       plan{};
    plan.sand         = world.sand.size() > 0;
    plan.bodies       = world.bodies.size() > 0;
    plan.coupling     = plan.sand && plan.bodies;
    plan.body_contact = plan.bodies && (ranks > 1 || world.bodies.size() > 1 || !world.planes.empty());
    plan.rays         = world.bodies.size() > 1 && scene.numerics.narrow_phase == scene::NarrowPhase::rays;
    plan.plasticity   = plan.sand && std::any_of(scene.materials.begin(), scene.materials.end(), plastic);
    plan.affine       = plan.sand && scene.numerics.transfer != scene::Transfer::flip;
    plan.damping      = std::any_of(scene.phases.begin(), scene.phases.end(), damped);
    plan.rocks        = static_cast<std::int64_t>(world.bodies.size()) > world.bodies.named;
    plan.snapshots    = scene.output.snapshots_every > 0;
    plan.sleep        = plan.sand && scene.sleep.distance.has_value();
    plan.rock_sleep   = plan.rocks && plan.body_contact && scene.sleep.rock_speed.has_value();
    plan.mass_scaling = plan.rocks && scene::scales_inertia(scene);
    plan.motions      = std::any_of(scene.phases.begin(), scene.phases.end(), moved);
    plan.cap          = plan.sand && std::any_of(scene.materials.begin(), scene.materials.end(), capped);
    plan.nonlocal     = plan.sand && scene::softening_length(scene) > 0;
    return plan;
}

std::vector<Stage> stages(const scene::Scene&, const Plan& plan, int ranks)
{
    const auto needs = [](const char* name, bool on, const char* yes, const char* no) {
        return Stage{name, on, on ? yes : no};
    };
    const char* no_sand   = "no terrain of material points";
    const char* no_bodies = "no wheel and no rocks";
    const char* meet      = ranks > 1 ? "bodies on several ranks" : "bodies that may meet each other or a wall";
    const bool  alone     = plan.body_contact && !plan.coupling;
    return {
        needs(stage::order, plan.sand, "terrain", no_sand),
        needs(stage::sleep, plan.sleep, "sleep.distance", plan.sand ? "no sleep.distance" : no_sand),
        needs(stage::pairs, plan.body_contact, meet, no_bodies),
        needs(stage::candidates, plan.coupling, "sand and bodies", plan.sand ? no_bodies : no_sand),
        needs(stage::sand_contact, plan.coupling, "sand and bodies", plan.sand ? no_bodies : no_sand),
        needs(stage::body_contact, plan.body_contact, meet, plan.bodies ? "one body and no walls" : no_bodies),
        needs(stage::integrate, plan.bodies && !alone, "bodies", alone ? "part of body-body contact" : no_bodies),
        needs(stage::scatter, plan.sand, "terrain", no_sand),
        needs(stage::grid, plan.sand, "terrain", no_sand),
        needs(stage::gather, plan.sand, "terrain", no_sand),
        needs(stage::plasticity, plan.plasticity, "granular terrain; part of grid to points",
              plan.sand ? "elastic terrain" : no_sand),
        needs(stage::damping, plan.damping, "a phase with damping; part of grid and move bodies",
              "no phase with damping"),
        needs(stage::measure, true, "the next time step and the balances", ""),
        needs(stage::output, true, "time series", ""),
        needs(stage::snapshots, plan.snapshots, "snapshots_every", "output.snapshots_every = 0"),
        needs(stage::checkpoints, true, "[checkpoint], signals, the wall-time limit", ""),
        needs(stage::halo, ranks > 1 && plan.sand, "nodes that ranks share", ranks > 1 ? no_sand : "one rank"),
    };
}

} // namespace tread::solver
