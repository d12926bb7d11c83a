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

struct NamedMotion
{
    Vec3<double> position; ///< m
    Quat         orientation;
    Vec3<double> velocity; ///< m/s
    Vec3<double> spin;     ///< rad/s
};

/// Motions of the named bodies, on every rank those that their owners know. Collective.
template<class Exec>
std::vector<NamedMotion> named_motions(const BodyState<Exec>& state)
{
    const NamedMotion nothing{Vec3<double>::Zero(), Quat(0, 0, 0, 0), Vec3<double>::Zero(), Vec3<double>::Zero()};
    std::vector<NamedMotion> motions(static_cast<std::size_t>(state.named()), nothing);
    const auto               read_rows = [&](const auto& array, auto NamedMotion::*field)
    {
        std::vector<std::decay_t<decltype(motions[0].*field)>> values(motions.size());
        copy_to_host(state.exec, values.data(), array.data(), values.size() * sizeof(values[0]));
        for (std::size_t b = 0; b < motions.size(); ++b)
        {
            if (state.owns(static_cast<std::int64_t>(b))) { motions[b].*field = values[b]; }
        }
    };
    read_rows(state.bodies.position, &NamedMotion::position);
    read_rows(state.bodies.orientation, &NamedMotion::orientation);
    read_rows(state.bodies.velocity, &NamedMotion::velocity);
    read_rows(state.bodies.angular_velocity, &NamedMotion::spin);
    sum_over_ranks(state.communicator(), motions.data(), motions.size());
    return motions;
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
    std::vector<BodyRow>                   found;
    const world::World&                    world    = state.world;
    const std::vector<NamedMotion>         motions  = named_motions(state);
    const std::vector<dem::ContactImpulse> impulses = summed_impulses(state, means);
    for (std::size_t b = 0; b < impulses.size(); ++b)
    {
        const auto& [position, orientation, velocity, spin] = motions[b];
        const auto&        form = world.templates[static_cast<std::size_t>(world.bodies.shape[b])];
        const double       over = means.time > 0 ? 1 / means.time : 0;
        const Vec3<double> axle = orientation * Vec3<double>::UnitY();
        const double       drop = world.bodies.scale[b] * depth_below_centre(form, orientation);
        found.push_back({position, velocity, spin, over * impulses[b].linear, over * impulses[b].angular, axle,
                         position[2] - drop});
        found.back().orientation = orientation;
    }
    return found;
}

template<class Exec>
io::BodyFields body_fields(const BodyState<Exec>& state)
{
    const BodyBlocks         order  = state.blocks();
    const dem::Bodies<Exec>& bodies = state.bodies;
    io::BodyFields           fields;
    fields.position = rows(order.rows(bodies.position.to_host()));
    for (const Quat& q : order.rows(bodies.orientation.to_host()))
    {
        for (const double value : {q.w(), q.x(), q.y(), q.z()}) { fields.orientation.push_back(value); }
    }
    fields.velocity         = rows(order.rows(bodies.velocity.to_host()));
    fields.angular_velocity = rows(order.rows(bodies.angular_velocity.to_host()));
    fields.scale            = order.rows(bodies.scale.to_host());
    fields.shape            = order.rows(bodies.shape.to_host());
    fields.material         = order.rows(bodies.material.to_host());
    return fields;
}

template<class Exec>
void add_rocks(const BodyState<Exec>& state, world::TerrainBins& bins)
{
    const std::vector<Vec3<double>> position = state.bodies.position.to_host();
    const std::vector<double>       radius   = state.radii();
    for (auto b = static_cast<std::size_t>(state.named()); b < position.size(); ++b)
    {
        if (state.owns(static_cast<std::int64_t>(b))) { bins.add_sphere(position[b], radius[b]); }
    }
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
    template io::BodyFields       body_fields(const BodyState<Exec>&);                                                 \
    template void                 add_rocks(const BodyState<Exec>&, world::TerrainBins&);                              \
    template Vec3<double>         body_place(const BodyState<Exec>&, std::size_t)
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
