#include "solver/bodies/body_tables.hpp"

#include <algorithm>

#include "backend/instantiate.hpp"
#include "solver/bodies/bounding_radii.hpp"
#include "world/materials.hpp"

namespace tread::solver
{

template<class Exec>
BodyTables<Exec>::BodyTables(const Exec& exec, const scene::Scene& scene, const world::World& world, const Plan& plan)
    : templates(exec, world.templates)
    , rays(exec, plan.rays ? world.templates : std::vector<shape::ShapeTemplate>{})
    , properties(exec, "pair properties")
    , planes(exec, "walls")
    , bounding_radii(exec, "body bounding radii")
{
    const std::vector<dem::PairProperties> pairs = world::pair_properties(scene, 0);
    properties.assign(pairs);
    rolling = std::any_of(pairs.begin(), pairs.end(), [](const auto& pair) { return pair.rolling_friction > 0; });
    planes.assign(world.planes);
    law                             = {templates.views(),
                                       {properties.data(), static_cast<std::int32_t>(scene.materials.size() + 1)},
                                       planes.data(),
                                       static_cast<std::int32_t>(world.planes.size()),
                                       {world::hertz_factor(scene.numerics.hertz), scene.numerics.linear_overlap},
                                       rays.views()};
    const std::vector<double> radii = solver::bounding_radii(world);
    smallest_radius                 = *std::min_element(radii.begin(), radii.end());
}

#define TREAD_INSTANTIATE(Exec) template struct BodyTables<Exec>
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
