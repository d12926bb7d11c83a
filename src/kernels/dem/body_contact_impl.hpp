#pragma once

#include "kernels/dem/body_contact.hpp"
#include "kernels/dem/body_contact_kern.hpp"
#include "kernels/dem/pair_law_kern.hpp"
#include "kernels/dem/ray_field_kern.hpp"
#include "kernels/dem/sphere_contact_kern.hpp"

// The item function of a substep's body contacts; body_contact.cpp and body_contact.cu bring in the schedule.
namespace tread::dem::body_contact
{

/// Meet: how two bodies see each other, MeetByDistance or MeetByRays.
template<class Meet>
struct EvaluatePair
{
    Meet       meet;
    BodiesView bodies;
    BodyLaw    law;
    PairsView  pairs;
    double     dt;

    TREAD_HD void operator()(std::int64_t p) const
    {
        Patch              patch    = pairs.patch[p];
        const PairResponse response = answer(p, sum_nodes(p, OneLane{}), patch);
        pairs.patch[p]              = patch;
        pairs.response[p]           = response;
        pairs.peak[p]               = std::fmax(pairs.peak[p], response.overlap);
    }

    /// What a pair's nodes add up to, for lanes that share them.
    template<class Lanes>
    TREAD_HD NodeSums sum_nodes(std::int64_t p, const Lanes& lanes) const
    {
        const NodeRun nodes{pairs.node, pairs.first_node[p], pairs.first_node[p + 1]};
        if (nodes.first == nodes.end) { return no_nodes(); }
        const std::int64_t a = first_of(pairs.key[p]), b = second_of(pairs.key[p]);
        const Instance     of_a = instance_of(bodies, law.templates, a, bodies.position[a]);
        if (b >= bodies.count)
        {
            const Plane& plane = law.planes[b - bodies.count];
            return over(OneSide{{of_a, field_of(plane, bodies.position[a]), 1.0, 1.0}}, nodes,
                        law_against(bodies, law, a, plane), motion_alone(a), lanes);
        }
        const Instance of_b = instance_of(bodies, law.templates, b, bodies.position[a]);
        return over(meet(of_a, of_b), nodes, law_between(bodies, law, a, b), motion_of(a, b, of_b.centre), lanes);
    }

    /// The pair's answer; updates its record.
    TREAD_HD PairResponse answer(std::int64_t p, const NodeSums& nodes, Patch& patch) const
    {
        const std::int64_t a = first_of(pairs.key[p]), b = second_of(pairs.key[p]);
        if (b >= bodies.count)
        {
            const Plane&  plane = law.planes[b - bodies.count];
            const PairLaw pair  = law_against(bodies, law, a, plane);
            const Spins   spins{bodies.angular_velocity[a], Vec3<double>::Zero()};
            const double  radius = exact_radius(a);
            const auto    touch  = contact_with_plane(radius, field_of(plane, bodies.position[a]));
            return radius > 0 ? respond_as_spheres(pair, touch, motion_alone(a), spins, Vec3<double>::Zero(), patch, dt)
                              : respond_with(pair, nodes, motion_alone(a), spins, Vec3<double>::Zero(), patch);
        }
        const PairLaw        pair     = law_between(bodies, law, a, b);
        const Vec3<double>   arm      = bodies.position[b] - bodies.position[a];
        const RelativeMotion motion   = motion_of(a, b, arm);
        const Spins          spins    = {bodies.angular_velocity[a], bodies.angular_velocity[b]};
        const double         radius_a = exact_radius(a), radius_b = exact_radius(b);
        return radius_a > 0 && radius_b > 0 ? respond_as_spheres(pair, contact_of_spheres(radius_a, radius_b, arm),
                                                                 motion, spins, arm, patch, dt)
                                            : respond_with(pair, nodes, motion, spins, arm, patch);
    }

private:
    /// m; 0 of a body that is no exact sphere.
    TREAD_HD double exact_radius(std::int64_t b) const
    {
        return bodies.scale[b] * law.templates[bodies.shape[b]].sphere_radius;
    }

    TREAD_HD RelativeMotion motion_alone(std::int64_t a) const
    {
        return {bodies.velocity[a], bodies.angular_velocity[a]};
    }

    TREAD_HD RelativeMotion motion_of(std::int64_t a, std::int64_t b, const Vec3<double>& arm) const
    {
        const Vec3<double> spin_b = bodies.angular_velocity[b];
        return {bodies.velocity[a] - bodies.velocity[b] + spin_b.cross(arm), bodies.angular_velocity[a] - spin_b};
    }

    template<class Sides, class Lanes>
    TREAD_HD NodeSums over(const Sides& sides, const NodeRun& run, const PairLaw& pair, const RelativeMotion& motion,
                           const Lanes& lanes) const
    {
        const LaneNodes<Sides, Lanes> nodes(sides, run, lanes);
        Stiffness                     own{0, 0};
        nodes([&](const NodeInField& node) { add_stiffness(pair, node, Sides::stiffening(node), own); });
        NodeSums found{{lanes.sum(own.sum), lanes.largest(own.overlap)}, PatchSums::zero()};
        if (!(found.stiffness.overlap > 0)) { return found; }
        const double relaxation = relaxation_time(pair, found.stiffness.sum);
        nodes([&](const NodeInField& node) { add_node(pair, node, motion, relaxation, found.patch); });
        return found;
    }

    TREAD_HD PairResponse respond_with(const PairLaw& pair, const NodeSums& nodes, const RelativeMotion& motion,
                                       const Spins& spins, const Vec3<double>& arm, Patch& patch) const
    {
        return nodes.stiffness.overlap > 0 ? respond(pair, nodes.patch, nodes.stiffness, motion, spins, arm, patch, dt)
                                           : release(pair, patch);
    }
};

/// A launch of its own, in scenes that have it.
struct ResistRolling
{
    BodiesView bodies;
    BodyLaw    law;
    PairsView  pairs;
    double     dt;

    TREAD_HD void operator()(std::int64_t p) const
    {
        const std::int64_t a = first_of(pairs.key[p]), b = second_of(pairs.key[p]);
        const bool         wall = b >= bodies.count;
        const PairLaw      pair =
            wall ? law_against(bodies, law, a, law.planes[b - bodies.count]) : law_between(bodies, law, a, b);
        const Spins spins{bodies.angular_velocity[a], wall ? Vec3<double>::Zero() : bodies.angular_velocity[b]};
        add_rolling(pair, pairs.patch[p], spins, pairs.response[p], pairs.rolling[p], dt);
    }
};

} // namespace tread::dem::body_contact
