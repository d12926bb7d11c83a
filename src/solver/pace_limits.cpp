#include "solver/pace_limits.hpp"

#include <algorithm>
#include <cmath>

#include "scene/phase_settings.hpp"
#include "solver/bodies/motion_bounds.hpp"
#include "world/materials.hpp"
#include "world/terrain.hpp"

namespace tread::solver
{
namespace
{

constexpr double longest_step = 0.02; ///< s, where nothing moves, so that the onset of motion is resolved

} // namespace

PaceLimits pace_limits(const scene::Scene& scene, const world::World& world, const Plan& plan)
{
    PaceLimits limits;
    limits.gravity             = scene::largest_gravity(scene);
    limits.longest             = longest_step;
    const MotionBounds motions = motion_bounds(scene, world);
    limits.gravity += motions.acceleration;
    limits.longest = std::min(limits.longest, motions.longest_step);
    if (plan.bodies)
    {
        limits.smallest_body = *std::min_element(world.bodies.radius.begin(), world.bodies.radius.end());
    }
    if (!plan.sand) { return limits; }
    double fewest = 1000; // least number of points in a cell
    for (const scene::Terrain& terrain : scene.terrain)
    {
        fewest            = std::min(fewest, std::pow(scene.grid.spacing / world::lattice_spacing(scene, terrain), 3));
        const auto& sand  = scene.materials[static_cast<std::size_t>(world::material_index(scene, terrain.material))];
        limits.wave_speed = std::max(limits.wave_speed, world::compression_wave_speed(sand));
    }
    limits.spacing = scene.grid.finest();
    limits.courant = fewest > 7.99 ? 0.6 : 0.4;
    return limits;
}

} // namespace tread::solver
