#include "solver/cover.hpp"

#include "solver/body_grid.hpp"
#include "solver/materials.hpp"

namespace tread::solver
{

std::vector<std::int32_t> covering_bodies(const scene::Scene& scene, const World& world, std::size_t first,
                                          std::size_t last)
{
    BodyGrid grid(world);
    for (std::size_t body = first; body < last; ++body) { grid.add(body); }
    const HostPoints&         points = world.points;
    const auto                rule   = radius_rule(scene.numerics.point_radius);
    std::vector<std::int32_t> covering(points.size(), -1);
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        const double radius = contact::point_radius(points.volume[i], rule);
        grid.any_near(points.position[i], radius,
                      [&](std::size_t body)
                      {
                          if (distance(world, body, points.position[i]) >= radius) { return false; }
                          covering[i] = static_cast<std::int32_t>(body);
                          return true;
                      });
    }
    return covering;
}

} // namespace tread::solver
