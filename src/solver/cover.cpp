#include "solver/cover.hpp"

#include <algorithm>

#include "kernels/contact/samples_kern.hpp"
#include "solver/body_grid.hpp"
#include "solver/materials.hpp"

namespace tread::solver
{
namespace
{

/// Whether one of the samples of a point at x is within `radius` (m) of the body.
bool sample_touches(const World& world, std::size_t body, const Vec3<double>& x, double radius)
{
    const Vec3<double> arm = x - world.bodies.position[body];
    if (!(arm.norm() > 0)) { return true; }
    const contact::PatchAxes axes = contact::patch_axes(arm.normalized());
    for (int s = 0; s < contact::patch_samples; ++s)
    {
        if (distance(world, body, x + contact::patch_offset(axes, s, radius)) < radius) { return true; }
    }
    return false;
}

} // namespace

double sampled_below(const scene::Scene& scene, const HostPoints& points)
{
    if (points.size() == 0) { return 0; }
    const double largest = *std::max_element(points.volume.begin(), points.volume.end());
    return scene.numerics.refine_below * contact::point_radius(largest, radius_rule(scene.numerics.point_radius));
}

std::vector<std::int32_t> covering_bodies(const scene::Scene& scene, const World& world, std::size_t first,
                                          std::size_t last)
{
    BodyGrid grid(world);
    for (std::size_t body = first; body < last; ++body) { grid.add(body); }
    const HostPoints&         points = world.points;
    const auto                rule   = radius_rule(scene.numerics.point_radius);
    const double              below  = sampled_below(scene, points);
    const double              reach  = below > 0 ? 1 + contact::patch_reach : 1.0;
    std::vector<std::int32_t> covering(points.size(), -1);
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        const double radius = contact::point_radius(points.volume[i], rule);
        grid.any_near(points.position[i], reach * radius,
                      [&](std::size_t body)
                      {
                          const Vec3<double>& x = points.position[i];
                          const auto& form      = world.templates[static_cast<std::size_t>(world.bodies.shape[body])];
                          const bool  sampled   = world.bodies.scale[body] * form.equivalent_radius < below;
                          if (distance(world, body, x) >= radius &&
                              !(sampled && sample_touches(world, body, x, radius)))
                          {
                              return false;
                          }
                          covering[i] = static_cast<std::int32_t>(body);
                          return true;
                      });
    }
    return covering;
}

} // namespace tread::solver
