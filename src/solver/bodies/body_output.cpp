#include "solver/bodies/body_output.hpp"

#include <algorithm>
#include <cmath>

#include "backend/instantiate.hpp"
#include "kernels/dem/motion/sums.hpp"
#include "solver/ranks/over_ranks.hpp"

namespace tread::solver
{
namespace
{

template<class T>
std::vector<double> rows(const std::vector<T>& vectors)
{
    std::vector<double> out;
    for (const T& v : vectors) { out.insert(out.end(), v.data(), v.data() + v.size()); }
    return out;
}

/// m at scale 1, distance from the centre down to the lowest point; for a wheel, of the cylinder over its grousers,
/// which does not oscillate with each grouser.
double depth_below_centre(const shape::ShapeTemplate& form, const Quat& orientation)
{
    const Vec3<double> down = orientation.conjugate() * -Vec3<double>::UnitZ(); // in the body's frame
    if (form.is_wheel)
    {
        return form.wheel.radius * std::hypot(down[0], down[2]) + 0.5 * form.wheel.width * std::abs(down[1]);
    }
    if (form.sphere_radius > 0) { return form.sphere_radius; }
    double deepest = 0;
    for (const Vec3<double>& vertex : form.mesh.vertices) { deepest = std::max(deepest, down.dot(vertex)); }
    return deepest;
}

} // namespace

template<class Exec>
RigidCensus body_census(BodyState<Exec>& state, const dem::BodyTotals<Exec>& totals)
{
    const dem::BodySums sums = dem::sum_bodies(state.exec, state.pairs, state.view(), totals, state.gravity);
    RigidCensus         now{0, sums.kinetic, sums.contact, sums.potential, sums.momentum};
    sum_over_ranks(state.communicator(), now);
    now.mass = state.mass;
    return now;
}

template<class Exec>
std::vector<BodyRow> named_rows(BodyState<Exec>& state, const NamedMeans<Exec>& means)
{
    state.collect();
    std::vector<BodyRow>            found;
    const world::World&             world           = state.world;
    const std::vector<Quat>         orientation     = state.bodies.orientation.to_host();
    const std::vector<Vec3<double>> position        = state.bodies.position.to_host(),
                                    velocity        = state.bodies.velocity.to_host(),
                                    spin            = state.bodies.angular_velocity.to_host();
    const std::vector<dem::ContactImpulse> impulses = summed_impulses(state, means);
    for (std::size_t b = 0; b < impulses.size(); ++b)
    {
        const auto&        form = world.templates[static_cast<std::size_t>(world.bodies.shape[b])];
        const double       over = means.time > 0 ? 1 / means.time : 0;
        const Vec3<double> axle = orientation[b] * Vec3<double>::UnitY();
        const double       drop = world.bodies.scale[b] * depth_below_centre(form, orientation[b]);
        found.push_back({position[b], velocity[b], spin[b], over * impulses[b].linear, over * impulses[b].angular, axle,
                         position[b][2] - drop});
        found.back().orientation = orientation[b];
    }
    return found;
}

template<class Exec>
io::BodyFields body_fields(BodyState<Exec>& state)
{
    state.collect();
    io::BodyFields fields;
    fields.position = rows(state.bodies.position.to_host());
    for (const Quat& q : state.bodies.orientation.to_host())
    {
        for (const double value : {q.w(), q.x(), q.y(), q.z()}) { fields.orientation.push_back(value); }
    }
    fields.velocity         = rows(state.bodies.velocity.to_host());
    fields.angular_velocity = rows(state.bodies.angular_velocity.to_host());
    fields.scale            = state.bodies.scale.to_host();
    fields.shape            = state.bodies.shape.to_host();
    fields.material         = state.bodies.material.to_host();
    return fields;
}

template<class Exec>
Vec3<double> body_place(const BodyState<Exec>& state, std::size_t body)
{
    Vec3<double> at = Vec3<double>::Zero();
    if (state.owns(static_cast<std::int64_t>(body))) { at = read(state.exec, state.bodies.position.data() + body); }
    sum_over_ranks(state.communicator(), at);
    return at;
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template RigidCensus          body_census(BodyState<Exec>&, const dem::BodyTotals<Exec>&);                         \
    template std::vector<BodyRow> named_rows(BodyState<Exec>&, const NamedMeans<Exec>&);                               \
    template io::BodyFields       body_fields(BodyState<Exec>&);                                                       \
    template Vec3<double>         body_place(const BodyState<Exec>&, std::size_t)
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
