#pragma once

#include <cmath>
#include <cstdint>

#include "kernels/dem/bodies.hpp"
#include "kernels/dem/patch_kern.hpp"
#include "kernels/dem/sdf_kern.hpp"

// The contact of one pair: nodes of each body in the distance field of the other, tractions of both added to one wrench
// and one patch. Everything stands relative to the centre of the pair's first body, a, along the world's axes.
namespace tread::dem
{

/// What a body looks like from the centre of body a.
struct Instance
{
    const TemplateView* shape;
    double              scale;
    Mat3<double>        rotation; ///< body to world
    Vec3<double>        centre;   ///< m
};

TREAD_HD Instance instance_of(const BodiesView& bodies, const TemplateView* templates, std::int64_t b,
                              const Vec3<double>& origin)
{
    return {templates + bodies.shape[b], bodies.scale[b], bodies.orientation[b].toRotationMatrix(),
            bodies.position[b] - origin};
}

/// The distance field of a body.
struct BodyField
{
    Instance body;

    TREAD_HD double distance_from_centre(const Vec3<double>& y) const { return (y - body.centre).norm(); }
    TREAD_HD double reach() const { return body.shape->bounding_radius * body.scale; }

    /// m, on the field at places from which the inside is no further than r.
    TREAD_HD double bound(double r) const
    {
        const double furthest = r + surface_uncertainty(*body.shape, body.scale);
        return furthest + sdf_uncertainty(*body.shape, body.scale, furthest);
    }

    TREAD_HD SdfSample operator()(const Vec3<double>& y) const
    {
        const Vec3<double> local  = body.rotation.transpose() * (y - body.centre) / body.scale;
        const SdfSample    sample = sample_template_sdf(*body.shape, local);
        return {body.scale * sample.distance, body.rotation * sample.gradient};
    }
};

/// The distance field of a wall.
struct PlaneField
{
    Vec3<double> normal;
    double       offset; ///< m, from the centre of body a

    TREAD_HD double distance_from_centre(const Vec3<double>&) const { return 0; }
    TREAD_HD double reach() const { return 0; }
    TREAD_HD double bound(double r) const { return r; }

    TREAD_HD SdfSample operator()(const Vec3<double>& y) const { return {normal.dot(y) - offset, normal}; }
};

/// One body's nodes in the other side's field.
template<class Field>
struct Side
{
    Instance owner;
    Field    field;
    double   share; ///< of a node's area: 1/2 where both sides have nodes, 1 against a plane
    double   sign;  ///< +1 if the owner is body a, -1 if it is b

    TREAD_HD Vec3<double> node(std::int32_t i) const
    {
        return owner.centre + owner.rotation * (owner.scale * owner.shape->node_positions[i]);
    }

    TREAD_HD double weight(std::int32_t i) const
    {
        return share * owner.scale * owner.scale * owner.shape->node_areas[i];
    }

    /// False only if no node of the cluster can be inside the other body (its distance has slope 1).
    TREAD_HD bool near(std::int32_t cluster) const
    {
        const Vec3<double> y = owner.centre + owner.rotation * (owner.scale * owner.shape->cluster_centres[cluster]);
        const double       r = owner.scale * owner.shape->cluster_radii[cluster];
        if (field.distance_from_centre(y) > r + field.reach()) { return false; }
        return field(y).distance <= field.bound(r);
    }
};

/// What one thread does alone; the GPU deals the clusters and nodes of a pair to the 32 lanes of a warp instead.
struct OneLane
{
    TREAD_HD std::int32_t lane() const { return 0; }
    TREAD_HD std::int32_t lanes() const { return 1; }
    TREAD_HD std::uint32_t vote(bool value) const { return value ? 1u : 0u; } ///< bit l = the value of lane l
    TREAD_HD double        sum(double value) const { return value; }
    TREAD_HD double        largest(double value) const { return value; }
};

inline constexpr std::int32_t cluster_size = 32; ///< nodes, shape::SurfaceNodes

/// Clusters with a node inside the other body: bit (cluster mod 64), so that the second walk skips nearly all others.
using LiveClusters = std::uint64_t;

TREAD_HD LiveClusters cluster_bit(std::int32_t cluster) { return LiveClusters{1} << (cluster & 63); }

template<class Field, class Lanes, class Visit>
TREAD_HD void visit_cluster(const Side<Field>& side, const Lanes& lanes, std::int32_t cluster, Visit visit)
{
    const std::int32_t first = cluster * cluster_size, nodes = side.owner.shape->node_count;
    const std::int32_t last = first + cluster_size < nodes ? first + cluster_size : nodes;
    for (std::int32_t i = first + lanes.lane(); i < last; i += lanes.lanes()) { visit(i); }
}

struct Stiffness
{
    double sum;     ///< N/m, of w p'(d) over the nodes inside
    double overlap; ///< m, the largest
};

/// First walk, adds this lane's nodes to `found`.
template<class Field, class Lanes>
TREAD_HD LiveClusters find_live(const PairLaw& law, const Side<Field>& side, const Lanes& lanes, Stiffness& found)
{
    LiveClusters       live     = 0;
    const std::int32_t clusters = side.owner.shape->cluster_count;
    for (std::int32_t base = 0; base < clusters; base += lanes.lanes())
    {
        const std::int32_t own  = base + lanes.lane();
        std::uint32_t      near = lanes.vote(own < clusters && side.near(own));
        for (std::int32_t cluster = base; near != 0; ++cluster, near >>= 1)
        {
            if ((near & 1u) == 0) { continue; }
            bool touched = false;
            visit_cluster(side, lanes, cluster,
                          [&](std::int32_t i)
                          {
                              const double overlap = -side.field(side.node(i)).distance;
                              if (!(overlap > 0)) { return; }
                              touched = true;
                              found.sum += side.weight(i) * traction_at(law, overlap).slope;
                              found.overlap = overlap > found.overlap ? overlap : found.overlap;
                          });
            if (lanes.vote(touched) != 0) { live |= cluster_bit(cluster); }
        }
    }
    return live;
}

/// Sums over the nodes inside; y = place relative to the centre of a, f = length of the node's force.
struct PatchSums
{
    Vec3<double> force;   ///< N, on a
    Vec3<double> moment;  ///< N m, on a
    double       weight;  ///< sum of f
    Vec3<double> first;   ///< sum of f y
    Sym3<double> second;  ///< sum of f y y^T
    double       energy;  ///< J
    double       damping; ///< W, lost to normal damping

    TREAD_HD static PatchSums zero()
    {
        return {Vec3<double>::Zero(), Vec3<double>::Zero(), 0, Vec3<double>::Zero(), Sym3<double>::Zero(), 0, 0};
    }

    /// Adds the lanes, in a fixed order.
    template<class Lanes>
    TREAD_HD void reduce(const Lanes& lanes)
    {
        for (int c = 0; c < 3; ++c)
        {
            force[c]  = lanes.sum(force[c]);
            moment[c] = lanes.sum(moment[c]);
            first[c]  = lanes.sum(first[c]);
        }
        for (int c = 0; c < 6; ++c) { second[c] = lanes.sum(second[c]); }
        weight  = lanes.sum(weight);
        energy  = lanes.sum(energy);
        damping = lanes.sum(damping);
    }
};

/// Velocity of a's material relative to b's, at y.
struct RelativeMotion
{
    Vec3<double> velocity; ///< m/s, at the centre of a
    Vec3<double> spin;     ///< rad/s

    TREAD_HD Vec3<double> at(const Vec3<double>& y) const { return velocity + spin.cross(y); }
};

/// Force of one node inside: w (p(d) + damping) grad phi, never attraction. Proportional to the node's own stiffness,
/// the damping gives the same restitution on flat faces as on spheres (prototypes 1.5); d' = -grad phi . v exactly.
/// relaxation = 2 zeta sqrt(m*/K), s.
template<class Field>
TREAD_HD void add_node(const PairLaw& law, const Side<Field>& side, const RelativeMotion& motion, double relaxation,
                       std::int32_t i, PatchSums& sums)
{
    const Vec3<double> y      = side.node(i);
    const SdfSample    sample = side.field(y);
    if (!(sample.distance < 0)) { return; }
    const double   weight   = side.weight(i);
    const Traction traction = traction_at(law, -sample.distance);
    const double   rate     = -side.sign * sample.gradient.dot(motion.at(y));
    const double   elastic  = weight * traction.pressure;
    const double   damping  = std::fmax(weight * traction.slope * relaxation * rate, -elastic);

    const Vec3<double> force  = side.sign * (elastic + damping) * sample.gradient;
    const double       length = force.norm();
    sums.force += force;
    sums.moment += y.cross(force);
    sums.weight += length;
    sums.first += length * y;
    sums.second += length * Sym3<double>(y[0] * y[0], y[1] * y[1], y[2] * y[2], y[1] * y[2], y[0] * y[2], y[0] * y[1]);
    sums.energy += weight * traction.energy;
    sums.damping += damping * rate;
}

/// Second walk, over the clusters that the first found.
template<class Field, class Lanes>
TREAD_HD void add_nodes(const PairLaw& law, const Side<Field>& side, const RelativeMotion& motion, double relaxation,
                        LiveClusters live, const Lanes& lanes, PatchSums& sums)
{
    for (std::int32_t cluster = 0; live != 0 && cluster < side.owner.shape->cluster_count; ++cluster)
    {
        if ((live & cluster_bit(cluster)) == 0) { continue; }
        visit_cluster(side, lanes, cluster, [&](std::int32_t i) { add_node(law, side, motion, relaxation, i, sums); });
    }
}

/// sum f |y - x_c|^2 in the plane normal to n, over sum f.
TREAD_HD double spread_about(const PatchSums& sums, const Vec3<double>& centre, const Vec3<double>& normal)
{
    Mat3<double> second;
    second << sums.second[0], sums.second[5], sums.second[4], sums.second[5], sums.second[1], sums.second[3],
        sums.second[4], sums.second[3], sums.second[2];
    const Mat3<double> central = second / sums.weight - centre * centre.transpose();
    return std::fmax(central.trace() - normal.dot(central * normal), 0.0);
}

/// What a pair does to its bodies in one substep.
struct PairResponse
{
    Vec3<double> force;       ///< N, on a; b gets its opposite
    Vec3<double> torque_a;    ///< N m, about the centre of a
    Vec3<double> torque_b;    ///< N m, about the centre of b
    double       stiffness;   ///< N/m, K
    double       overlap;     ///< m, the largest of its nodes
    double       energy;      ///< J, elastic, springs of the patch included
    double       friction;    ///< J, lost in this substep to tangential and torsional friction
    double       restitution; ///< J, lost in this substep to normal damping
};

TREAD_HD PairResponse no_response()
{
    return {Vec3<double>::Zero(), Vec3<double>::Zero(), Vec3<double>::Zero(), 0, 0, 0, 0, 0};
}

/// Turning of the two sides; b = 0 against a plane.
struct Spins
{
    Vec3<double> a;
    Vec3<double> b;
};

/// From the sums to the wrench; updates the record. `arm` = centre of b relative to that of a, m.
TREAD_HD PairResponse respond(const PairLaw& law, const PatchSums& sums, const Stiffness& found,
                              const RelativeMotion& motion, const Spins& spins, const Vec3<double>& arm, Patch& patch,
                              double dt)
{
    PairResponse response = no_response();
    response.force        = sums.force;
    response.torque_a     = sums.moment;
    response.stiffness    = found.sum;
    response.overlap      = found.overlap;
    response.energy       = sums.energy;
    response.restitution  = dt * sums.damping;

    const double load = sums.force.norm();
    if (law.friction > 0 && load > 0)
    {
        const Vec3<double> normal = sums.force / load;
        const Vec3<double> centre = sums.first / sums.weight;
        const PatchState   state{normal,
                               load,
                               found.sum,
                               spread_about(sums, centre, normal),
                               motion.at(centre),
                               motion.spin.dot(normal),
                               0.5 * (spins.a + spins.b).dot(normal)};
        const Friction     friction = update_patch(law, state, patch, dt);
        response.force += friction.force;
        response.torque_a += centre.cross(friction.force) + friction.moment * normal;
        response.energy += friction.energy;
        response.friction = friction.lost;
    }
    else
    {
        response.friction = held_energy(law, patch);
        patch             = no_patch();
        patch.stiffness   = found.sum;
    }
    response.torque_b = arm.cross(response.force) - response.torque_a;
    return response;
}

/// A pair that is apart: the record is lost, and with it what its springs held.
TREAD_HD PairResponse release(const PairLaw& law, Patch& patch)
{
    PairResponse response = no_response();
    response.friction     = held_energy(law, patch);
    patch                 = no_patch();
    return response;
}

TREAD_HD double relaxation_time(const PairLaw& law, double stiffness)
{
    return 2.0 * law.damping_ratio * std::sqrt(law.reduced_mass / stiffness);
}

} // namespace tread::dem
