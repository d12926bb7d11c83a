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

    template<class Lanes>
    TREAD_HD void operator()(std::int64_t p, const Lanes& lanes) const
    {
        Patch              patch    = pairs.patch[p];
        PairResponse response = respond_of(p, lanes, patch);
        if (lanes.lane() != 0) { return; }
        if (pairs.rolling != nullptr) { resist_rolling(p, patch, response); }
        pairs.patch[p]    = patch;
        pairs.response[p] = response;
        pairs.peak[p]     = std::fmax(pairs.peak[p], response.overlap);
    }

    /// `patch` = the pair's, after the substep; that before it is still in the list.
    TREAD_HD void resist_rolling(std::int64_t p, const Patch& patch, PairResponse& response) const
    {
        const std::int64_t a = first_of(pairs.key[p]), b = second_of(pairs.key[p]);
        const bool         wall = b >= bodies.count;
        const PairLaw      pair =
            wall ? law_against(bodies, law, a, law.planes[b - bodies.count]) : law_between(bodies, law, a, b);
        const Spins spins{bodies.angular_velocity[a], wall ? Vec3<double>::Zero() : bodies.angular_velocity[b]};
        add_rolling(pair, pairs.patch[p], patch, spins, response, pairs.rolling[p], dt);
    }

    template<class Lanes>
    TREAD_HD PairResponse respond_of(std::int64_t p, const Lanes& lanes, Patch& patch) const
    {
        const std::int64_t a = first_of(pairs.key[p]), b = second_of(pairs.key[p]);
        const NodeRun      nodes{pairs.node, pairs.first_node[p], pairs.first_node[p + 1]};
        return b < bodies.count ? between_bodies(a, b, nodes, lanes, patch)
                                : against_plane(a, b - bodies.count, nodes, lanes, patch);
    }

    template<class Lanes>
    TREAD_HD PairResponse between_bodies(std::int64_t a, std::int64_t b, const NodeRun& nodes, const Lanes& lanes,
                                         Patch& patch) const
    {
        const PairLaw        pair = law_between(bodies, law, a, b);
        const Instance       of_a = instance_of(bodies, law.templates, a, bodies.position[a]);
        const Instance       of_b = instance_of(bodies, law.templates, b, bodies.position[a]);
        const Spins          spins{bodies.angular_velocity[a], bodies.angular_velocity[b]};
        const RelativeMotion motion{bodies.velocity[a] - bodies.velocity[b] + spins.b.cross(of_b.centre),
                                    spins.a - spins.b};
        if (is_sphere(of_a) && is_sphere(of_b))
        {
            return respond_as_spheres(pair, contact_of_spheres(of_a, of_b), motion, spins, of_b.centre, patch, dt);
        }
        return over_nodes(pair, meet(of_a, of_b), nodes, motion, spins, of_b.centre, lanes, patch);
    }

    template<class Lanes>
    TREAD_HD PairResponse against_plane(std::int64_t a, std::int64_t p, const NodeRun& nodes, const Lanes& lanes,
                                        Patch& patch) const
    {
        const Plane&         plane = law.planes[p];
        const PairLaw        pair  = law_against(bodies, law, a, plane);
        const Instance       of_a  = instance_of(bodies, law.templates, a, bodies.position[a]);
        const PlaneField     wall  = field_of(plane, bodies.position[a]);
        const Spins          spins{bodies.angular_velocity[a], Vec3<double>::Zero()};
        const RelativeMotion motion{bodies.velocity[a], spins.a};
        const Vec3<double>   no_arm = Vec3<double>::Zero();
        if (is_sphere(of_a))
        {
            return respond_as_spheres(pair, contact_with_plane(of_a, wall), motion, spins, no_arm, patch, dt);
        }
        return over_nodes(pair, OneSide{{of_a, wall, 1.0, 1.0}}, nodes, motion, spins, no_arm, lanes, patch);
    }

    template<class Sides, class Lanes>
    TREAD_HD PairResponse over_nodes(const PairLaw& pair, const Sides& sides, const NodeRun& run,
                                     const RelativeMotion& motion, const Spins& spins, const Vec3<double>& arm,
                                     const Lanes& lanes, Patch& patch) const
    {
        if (run.first == run.end) { return release(pair, patch); }
        const LaneNodes<Sides, Lanes> nodes(sides, run, lanes);
        Stiffness                     own{0, 0};
        nodes([&](const NodeInField& node) { add_stiffness(pair, node, Sides::stiffening(node), own); });
        const Stiffness found{lanes.sum(own.sum), lanes.largest(own.overlap)};
        if (!(found.overlap > 0)) { return release(pair, patch); }

        const double relaxation = relaxation_time(pair, found.sum);
        PatchSums    sums       = PatchSums::zero();
        nodes([&](const NodeInField& node) { add_node(pair, node, motion, relaxation, sums); });
        sums.reduce(lanes);
        return respond(pair, sums, found, motion, spins, arm, patch, dt);
    }
};

} // namespace tread::dem::body_contact
