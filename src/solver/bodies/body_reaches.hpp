#pragma once

#include "kernels/dem/bodies.hpp"
#include "solver/sand/page_rest.hpp"
#include "world/world.hpp"

namespace tread::solver
{

/// Copies the present bounding spheres of the bodies that are awake to the host; synchronises.
template<class Exec>
std::vector<BodyReach> awake_reaches(const Exec& exec, const dem::BodiesView& bodies, const world::World& world)
{
    std::vector<Vec3<double>> centre(static_cast<std::size_t>(bodies.count));
    copy_to_host(exec, centre.data(), bodies.position, centre.size() * sizeof(Vec3<double>));
    std::vector<std::int32_t> asleep(bodies.asleep != nullptr ? centre.size() : 0);
    copy_to_host(exec, asleep.data(), bodies.asleep, asleep.size() * sizeof(std::int32_t));
    std::vector<BodyReach> reaches;
    for (std::size_t b = 0; b < centre.size(); ++b)
    {
        if (!asleep.empty() && asleep[b] != 0) { continue; }
        const auto& form = world.templates[static_cast<std::size_t>(world.bodies.shape[b])];
        reaches.push_back({centre[b], form.bounding_radius * world.bodies.scale[b]});
    }
    return reaches;
}

} // namespace tread::solver
