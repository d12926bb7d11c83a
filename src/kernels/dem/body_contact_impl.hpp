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
        Couple             couple;
        Patch              patch    = pairs.patch[p];
        const PairResponse response = answer(p, sum_nodes(p, OneLane{}, couple), patch);
        pairs.patch[p]              = patch;
        pairs.response[p]           = response;
        pairs.peak[p]               = std::fmax(pairs.peak[p], response.overlap);
    }

    /// What a pair's nodes add up to, for lanes that share them: each lane gets the stiffness of all and its own part
    /// of the patch's sums.
    template<class Lanes>
    TREAD_HD NodeSums sum_nodes(std::int64_t p, const Lanes& lanes, Couple& couple) const
    {
        const NodeRun nodes{pairs.node, pairs.first_node[p], pairs.first_node[p + 1]};
        if (nodes.first == nodes.end) { return no_nodes(); }
        const std::int64_t   a = first_of(pairs.key[p]), b = second_of(pairs.key[p]);
        const PairLaw        pair   = law_of(bodies, law, pairs.key[p]);
        const RelativeMotion motion = motion_of(a, b, arm_of(a, b));
        const bool           wall   = b >= bodies.count;
        for (int body = lanes.lane(); body < (wall ? 1 : 2); body += lanes.lanes())
        {
            couple.body[body] = instance_of(bodies, law.templates, body == 0 ? a : b, bodies.position[a]);
        }
        lanes.meet();
        if (wall)
        {
            const PlaneField plane = field_of(law.planes[b - bodies.count], bodies.position[a]);
            return over(OneSide{{couple.body[0], plane, 1.0, 1.0}}, nodes, pair, motion, lanes);
        }
        return over(TwoSides<Meet>{meet, couple}, nodes, pair, motion, lanes);
    }

    /// The pair's answer; updates its record.
    TREAD_HD PairResponse answer(std::int64_t p, NodeSums sums, Patch& patch) const
    {
        const std::int64_t   a = first_of(pairs.key[p]), b = second_of(pairs.key[p]);
        const PairLaw        pair   = law_of(bodies, law, pairs.key[p]);
        const Vec3<double>   arm    = arm_of(a, b);
        const RelativeMotion motion = motion_of(a, b, arm);
        if (closed_form(a, b)) { sums = sums_of_spheres(pair, touch_of(a, b, arm), motion); }
        if (!(sums.stiffness.overlap > 0)) { return release(pair, patch); }
        const Spins spins{bodies.angular_velocity[a], bodies.angular_velocity[a] - motion.spin};
        return respond(pair, sums, motion, spins, arm, patch, dt);
    }

private:
    /// m; 0 of a body that is no exact sphere.
    TREAD_HD double exact_radius(std::int64_t b) const
    {
        return bodies.scale[b] * law.templates[bodies.shape[b]].sphere_radius;
    }

    TREAD_HD bool closed_form(std::int64_t a, std::int64_t b) const
    {
        return exact_radius(a) > 0 && (b >= bodies.count || exact_radius(b) > 0);
    }

    TREAD_HD SphereContact touch_of(std::int64_t a, std::int64_t b, const Vec3<double>& arm) const
    {
        return b < bodies.count
                   ? contact_of_spheres(exact_radius(a), exact_radius(b), arm)
                   : contact_with_plane(exact_radius(a), field_of(law.planes[b - bodies.count], bodies.position[a]));
    }

    /// Centre of b relative to that of a, m; none of a wall.
    TREAD_HD Vec3<double> arm_of(std::int64_t a, std::int64_t b) const
    {
        return b < bodies.count ? Vec3<double>(bodies.position[b] - bodies.position[a])
                                : Vec3<double>(Vec3<double>::Zero());
    }

    TREAD_HD RelativeMotion motion_of(std::int64_t a, std::int64_t b, const Vec3<double>& arm) const
    {
        if (b >= bodies.count) { return {bodies.velocity[a], bodies.angular_velocity[a]}; }
        const Vec3<double> spin_b = bodies.angular_velocity[b];
        return {bodies.velocity[a] - bodies.velocity[b] + spin_b.cross(arm), bodies.angular_velocity[a] - spin_b};
    }

    template<class Sides, class Lanes>
    TREAD_HD NodeSums over(const Sides& sides, const NodeRun& run, const PairLaw& pair, const RelativeMotion& motion,
                           const Lanes& lanes) const
    {
        NodeSums   found      = no_nodes();
        double     relaxation = 0;
        const auto ready      = [&]
        {
            found.stiffness = {lanes.sum(found.stiffness.sum), lanes.largest(found.stiffness.overlap)};
            relaxation      = relaxation_time(pair, found.stiffness.sum);
            return found.stiffness.overlap > 0;
        };
        walk_twice(
            sides, run, lanes,
            [&](const NodeInField& node) { add_stiffness(pair, node, Sides::stiffening(node), found.stiffness); },
            ready, [&](const NodeInField& node) { add_node(pair, node, motion, relaxation, found.patch); });
        return found;
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
        const PairLaw      pair = law_of(bodies, law, pairs.key[p]);
        const Spins        spins{bodies.angular_velocity[a], wall ? Vec3<double>::Zero() : bodies.angular_velocity[b]};
        add_rolling(pair, pairs.patch[p], spins, pairs.response[p], pairs.rolling[p], dt);
    }
};

} // namespace tread::dem::body_contact
