#pragma once

#include <cmath>

#include "kernels/dem/contact/body_field_kern.hpp"
#include "kernels/dem/contact/patch_kern.hpp"

// Contact of one pair: the nodes of each body are evaluated in the field of the other, and the tractions of both are
// added to one wrench and one patch.
namespace tread::dem
{

struct Stiffness
{
    double sum;     ///< N/m, of w p'(d) over the nodes inside
    double overlap; ///< m, maximum
};

/// Adds the stiffness of a node inside.
TREAD_HD void add_stiffness(const PairLaw& law, const NodeInField& node, double stiffening, Stiffness& found)
{
    found.sum += stiffening * node.weight * traction_at(law, node.overlap).slope;
    found.overlap = node.overlap > found.overlap ? node.overlap : found.overlap;
}

/// Sums over the nodes inside; y = position relative to the centre of a, f = magnitude of the node's force.
struct PatchSums
{
    Vec3<double> force;   ///< N, on a
    Vec3<double> moment;  ///< N m, on a
    double       weight;  ///< sum of f
    Vec3<double> first;   ///< sum of f y
    Sym3<double> second;  ///< sum of f y y^T
    double       energy;  ///< J
    double       damping; ///< W, dissipated by normal damping

    /// Sums over the lanes that share a pair.
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

    TREAD_HD static PatchSums zero()
    {
        return {Vec3<double>::Zero(), Vec3<double>::Zero(), 0, Vec3<double>::Zero(), Sym3<double>::Zero(), 0, 0};
    }
};

/// All sums over the nodes of a pair.
struct NodeSums
{
    Stiffness stiffness;
    PatchSums patch;
};

TREAD_HD NodeSums no_nodes() { return {{0, 0}, PatchSums::zero()}; }

/// Velocity of a's material relative to b's, at y.
struct RelativeMotion
{
    Vec3<double> velocity; ///< m/s, at the centre of a
    Vec3<double> spin;     ///< rad/s

    TREAD_HD Vec3<double> at(const Vec3<double>& y) const { return velocity + spin.cross(y); }
};

/// Adds the force of one node inside: w (p(d) + damping) grad phi, never attractive. Damping is proportional to the
/// node's own stiffness, so that flat faces have the same restitution as spheres (docs/theory.md#restitution); d' =
/// -grad phi . v exactly. relaxation = 2 zeta sqrt(m*/K), s.
TREAD_HD void add_node(const PairLaw& law, const NodeInField& node, const RelativeMotion& motion, double relaxation,
                       PatchSums& sums)
{
    const Vec3<double>& y        = node.place;
    const Traction      traction = traction_at(law, node.overlap);
    const double        rate     = -node.sign * node.gradient.dot(motion.at(y));
    const double        elastic  = node.weight * traction.pressure;
    const double        damping  = std::fmax(node.weight * traction.slope * relaxation * rate, -elastic);

    const Vec3<double> force  = node.sign * (elastic + damping) * node.gradient;
    const double       length = force.norm();
    sums.force += force;
    sums.moment += y.cross(force);
    sums.weight += length;
    sums.first += length * y;
    sums.second += length * Sym3<double>(y[0] * y[0], y[1] * y[1], y[2] * y[2], y[1] * y[2], y[0] * y[2], y[0] * y[1]);
    sums.energy += node.weight * traction.energy;
    sums.damping += damping * rate;
}

/// Returns sum f |y - x_c|^2 in the plane normal to the unit vector n, divided by sum f.
TREAD_HD double spread_about(const PatchSums& sums, double inverse_weight, const Vec3<double>& centre,
                             const Vec3<double>& n)
{
    const Sym3<double>& s     = sums.second;
    const double        along = s[0] * n[0] * n[0] + s[1] * n[1] * n[1] + s[2] * n[2] * n[2] +
                         2.0 * (s[3] * n[1] * n[2] + s[4] * n[0] * n[2] + s[5] * n[0] * n[1]);
    const double off = centre.dot(n);
    return std::fmax(inverse_weight * (s[0] + s[1] + s[2] - along) - (centre.squaredNorm() - off * off), 0.0);
}

/// Response of a pair: its action on the two bodies in one substep.
struct PairResponse
{
    Vec3<double> force;       ///< N, on a; b gets the opposite force
    Vec3<double> torque_a;    ///< N m, about the centre of a
    Vec3<double> torque_b;    ///< N m, about the centre of b
    double       stiffness;   ///< N/m, K
    double       overlap;     ///< m, maximum over its nodes
    double       energy;      ///< J, elastic, including the springs of the patch
    double       friction;    ///< J, dissipated in this substep by tangential and torsional friction
    double       restitution; ///< J, dissipated in this substep by normal damping
};

TREAD_HD PairResponse no_response()
{
    return {Vec3<double>::Zero(), Vec3<double>::Zero(), Vec3<double>::Zero(), 0, 0, 0, 0, 0};
}

/// Angular velocities of the two bodies, rad/s; b = 0 against a plane.
struct Spins
{
    Vec3<double> a;
    Vec3<double> b;
};

/// Computes the wrench from the sums and updates the record. `arm` = centre of b relative to that of a, m.
TREAD_HD PairResponse respond(const PairLaw& law, const NodeSums& nodes, const RelativeMotion& motion,
                              const Spins& spins, const Vec3<double>& arm, Patch& patch, double dt)
{
    const PatchSums& sums     = nodes.patch;
    const Stiffness& found    = nodes.stiffness;
    PairResponse     response = no_response();
    response.force            = sums.force;
    response.torque_a         = sums.moment;
    response.stiffness        = found.sum;
    response.overlap          = found.overlap;
    response.energy           = sums.energy;
    response.restitution      = dt * sums.damping;

    const double load = sums.force.norm();
    if (law.friction > 0 && load > 0)
    {
        const double       inverse_weight = 1.0 / sums.weight;
        const Vec3<double> normal         = (1.0 / load) * sums.force;
        const Vec3<double> centre         = inverse_weight * sums.first;
        const PatchState   state{normal,
                               load,
                               found.sum,
                               spread_about(sums, inverse_weight, centre, normal),
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

/// Response of a pair that is not in contact: clears the record; the energy of its springs is dissipated.
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
