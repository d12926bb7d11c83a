#include "world/footing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "world/body_grid.hpp"

namespace tread::world
{
namespace
{

constexpr double infinity = std::numeric_limits<double>::infinity();

/// m, half the length of the strip across the wheel's path in which its ground is measured.
double half_strip(const Footing& footing, const World& world)
{
    return std::max(0.25 * footing.radius, world.point_spacing);
}

/// Calls act(point) for the points of the strip, across the path, that contains the body.
template<class Act>
void each_in_strip(const Footing& footing, const World& world, const Act& act)
{
    const Vec3<double>& at   = world.bodies.position[footing.body];
    const double        half = half_strip(footing, world);
    for_each_point(world.sand,
                   [&](const SandPoint& point)
                   {
                       const Vec3<double>& x = point.position;
                       if (std::abs(x[0] - at[0]) <= half && x[2] < at[2]) { act(point); }
                   });
}

/// Whether a bed that ends at y does so at a wall of the domain.
bool ends_at_wall(const scene::Scene& scene, double y)
{
    const double from_wall = std::min(y, scene.domain.size[1] - y);
    return scene.domain.walls.y != scene::WallKind::open && from_wall < scene.grid.spacing;
}

std::optional<Ground> ground_under(const scene::Scene& scene, const Footing& footing, const World& world)
{
    const double y    = world.bodies.position[footing.body][1];
    const double half = std::max(0.5 * footing.width, 0.5 * world.point_spacing);
    double       top = -infinity, bottom = infinity;
    int          material = -1;
    each_in_strip(footing, world,
                  [&](const SandPoint& point)
                  {
                      const Vec3<double>& x = point.position;
                      if (std::abs(x[1] - y) > half) { return; }
                      bottom = std::min(bottom, x[2]);
                      if (x[2] <= top) { return; }
                      top      = x[2];
                      material = point.kind.material;
                  });
    if (material < 0) { return std::nullopt; }
    const double upper = 0.5 * (top + bottom);
    double       low = infinity, high = -infinity;
    each_in_strip(footing, world,
                  [&](const SandPoint& point)
                  {
                      const Vec3<double>& x = point.position;
                      if (x[2] < upper) { return; }
                      low  = std::min(low, x[1]);
                      high = std::max(high, x[1]);
                  });
    const double around = 0.5 * world.point_spacing;
    const bool   below  = y - low < high - y; // the nearer edge is the one at low y
    const double beside = std::min(y - low, high - y) + around - 0.5 * footing.width;
    return Ground{material, top + around, top - bottom + 2 * around, beside, ends_at_wall(scene, below ? low : high)};
}

/// m, distance from the body's round face to the nearest sand or rock below its centre.
std::optional<double> gap_of(const Footing& footing, const World& world)
{
    const Vec3<double>& at      = world.bodies.position[footing.body];
    double              nearest = infinity;
    const auto          meet    = [&](const Vec3<double>& x, double radius)
    {
        const Vec3<double> to = x - at;
        if (to[2] > 0 || std::abs(to[1]) > 0.5 * footing.width + radius || std::abs(to[0]) > footing.radius) { return; }
        nearest = std::min(nearest, std::hypot(to[0], to[2]) - footing.radius - radius);
    };
    for_each_point(world.sand, [&](const SandPoint& point) { meet(point.position, 0.5 * world.point_spacing); });
    for (auto b = static_cast<std::size_t>(world.bodies.named); b < world.bodies.size(); ++b)
    {
        meet(world.bodies.position[b], world.bodies.radius[b]);
    }
    return nearest < infinity ? std::optional<double>(nearest) : std::nullopt;
}

std::optional<Patch> patch_of(const Footing& footing, const scene::Scene& scene, const shape::ShapeTemplate& form)
{
    const bool round = form.is_wheel || form.sphere_radius > 0 || footing.driven;
    if (!round || !footing.ground || footing.load <= 0) { return std::nullopt; }
    const auto&     soil    = scene.materials[static_cast<std::size_t>(footing.ground->material)];
    const double    gravity = Vec3<double>(scene.domain.gravity.data()).norm();
    const RoundBody body{footing.radius, form.sphere_radius > 0 ? 0 : footing.width, footing.load};
    return scene::is_granular(soil.model) ? bearing_patch(soil, gravity, body) : hertz_patch(soil, body);
}

Footing footing_of(const scene::Scene& scene, const World& world, std::size_t b)
{
    const auto&  form    = template_of(world, b);
    const double scale   = world.bodies.scale[b];
    const auto   extent  = turned_box(world, b).extent();
    const double gravity = Vec3<double>(scene.domain.gravity.data()).norm();
    Footing      footing{};
    footing.body   = b;
    footing.driven = is_driven(scene, scene.bodies[b]);
    footing.load   = world.bodies.mass[b] * gravity;
    footing.radius = scale * (form.is_wheel ? form.wheel.radius : 0.5 * extent[2]);
    footing.width  = scale * (form.is_wheel ? form.box.extent()[1] : extent[1]);
    footing.ground = ground_under(scene, footing, world);
    footing.gap    = gap_of(footing, world);
    footing.patch  = patch_of(footing, scene, form);
    return footing;
}

} // namespace

bool is_driven(const scene::Scene& scene, const scene::Body& body)
{
    return std::any_of(scene.phases.begin(), scene.phases.end(),
                       [&](const scene::Phase& phase) { return phase.drive && phase.drive->body == body.name; });
}

std::vector<Footing> footings(const scene::Scene& scene, const World& world)
{
    std::vector<Footing> all;
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) { all.push_back(footing_of(scene, world, b)); }
    return all;
}

} // namespace tread::world
