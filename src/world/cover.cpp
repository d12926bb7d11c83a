#include "world/cover.hpp"

#include <algorithm>

#include "kernels/contact/samples_kern.hpp"
#include "world/body_grid.hpp"
#include "world/materials.hpp"
#include "world/touch_table.hpp"

namespace tread::world
{

double PointReach::search(double radius) const { return (sampled_below > 0 ? 1 + contact::patch_reach : 1.0) * radius; }

double sampled_below(const scene::Scene& scene, const HostPoints& points)
{
    if (points.size() == 0) { return 0; }
    const double largest = *std::max_element(points.volume.begin(), points.volume.end());
    return scene.numerics.refine_below * contact::point_radius(largest, radius_rule(scene.numerics.point_radius));
}

PointReach make_point_reach(const scene::Scene& scene, const HostPoints& points)
{
    return {radius_rule(scene.numerics.point_radius), sampled_below(scene, points)};
}

NearestPlace nearest_place(const World& world, const PointReach& reach, std::size_t body, const Vec3<double>& x,
                           double radius)
{
    const auto&  form = template_of(world, body);
    NearestPlace nearest{distance(world, body, x), x};
    if (!(world.bodies.scale[body] * form.equivalent_radius < reach.sampled_below)) { return nearest; }
    const Vec3<double> arm = x - world.bodies.position[body];
    if (!(arm.norm() > 0)) { return nearest; }
    const contact::PatchAxes axes = contact::patch_axes(arm.normalized());
    for (int s = 0; s < contact::patch_samples; ++s)
    {
        const Vec3<double> place = x + contact::patch_offset(axes, s, radius);
        const double       phi   = distance(world, body, place);
        if (phi < nearest.distance) { nearest = {phi, place}; }
    }
    return nearest;
}

std::vector<std::int32_t> covering_bodies(const scene::Scene& scene, const World& world, std::size_t first,
                                          std::size_t last)
{
    BodyGrid grid(world);
    for (std::size_t body = first; body < last; ++body) { grid.add(body); }
    const HostPoints&         points = world.points;
    const PointReach          reach  = make_point_reach(scene, points);
    const TouchTable          touch  = touch_table(scene, 0);
    std::vector<std::int32_t> covering(points.size(), -1);
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        const double radius = reach.radius(points.volume[i]);
        grid.any_near(points.position[i], reach.search(radius),
                      [&](std::size_t body)
                      {
                          if (!touch(points.material[i], world.bodies.material[body]) ||
                              nearest_place(world, reach, body, points.position[i], radius).distance >= radius)
                          {
                              return false;
                          }
                          covering[i] = static_cast<std::int32_t>(body);
                          return true;
                      });
    }
    return covering;
}

} // namespace tread::world
