#include "world/cover.hpp"

#include "kernels/contact/samples_kern.hpp"
#include "world/body_grid.hpp"
#include "world/materials.hpp"
#include "world/reached_cells.hpp"
#include "world/touch_table.hpp"

namespace tread::world
{

double PointReach::search(double radius) const { return (sampled_below > 0 ? 1 + contact::patch_reach : 1.0) * radius; }

double PointReach::farthest(const Sand& sand) const { return search(radius(largest_volume(sand))); }

double sampled_below(const scene::Scene& scene, const Sand& sand)
{
    if (sand.size() == 0) { return 0; }
    const double largest = contact::point_radius(largest_volume(sand), radius_rule(scene.numerics.point_radius));
    return scene.numerics.refine_below * largest;
}

PointReach make_point_reach(const scene::Scene& scene, const Sand& sand)
{
    return {radius_rule(scene.numerics.point_radius), sampled_below(scene, sand)};
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

std::vector<std::int64_t> covered_points(const scene::Scene& scene, const World& world)
{
    BodyGrid grid(world);
    for (std::size_t body = 0; body < world.bodies.size(); ++body) { grid.add(body); }
    const PointReach          reach = make_point_reach(scene, world.sand);
    const TouchTable          touch = touch_table(scene, 0);
    const ReachedCells        cells(world, reach.farthest(world.sand));
    std::vector<std::int64_t> covered(world.bodies.size(), 0);
    const auto                look = [&](const SandPoint& point)
    {
        if (!cells.may_be_near(point.position)) { return; }
        const double radius = reach.radius(point.kind.volume);
        grid.any_near(point.position, reach.search(radius),
                      [&](std::size_t body)
                      {
                          if (!touch(point.kind.material, world.bodies.material[body]) ||
                              nearest_place(world, reach, body, point.position, radius).distance >= radius)
                          {
                              return false;
                          }
#pragma omp atomic
                          ++covered[body];
                          return true;
                      });
    };
#pragma omp parallel for schedule(dynamic, 16)
    for (const PointRow& row : world.sand.rows) { for_each_point(world.sand, row, look); }
    return covered;
}

} // namespace tread::world
