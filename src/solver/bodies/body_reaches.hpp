#pragma once

#include "kernels/dem/bodies.hpp"
#include "solver/sand/page_rest.hpp"
#include "world/world.hpp"

namespace tread::solver
{

/// Copies the present bounding spheres of all bodies to the host; synchronises.
template<class Exec>
std::vector<BodyReach> body_reaches(const Exec& exec, const dem::BodiesView& bodies, const world::World& world)
{
    std::vector<Vec3<double>> centre(static_cast<std::size_t>(bodies.count));
    copy_to_host(exec, centre.data(), bodies.position, centre.size() * sizeof(Vec3<double>));
    std::vector<BodyReach> reaches;
    for (std::size_t b = 0; b < centre.size(); ++b)
    {
        const auto& form = world.templates[static_cast<std::size_t>(world.bodies.shape[b])];
        reaches.push_back({centre[b], form.bounding_radius * world.bodies.scale[b]});
    }
    return reaches;
}

} // namespace tread::solver
