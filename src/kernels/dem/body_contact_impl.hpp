#pragma once

#include "kernels/dem/body_contact.hpp"
#include "kernels/dem/body_contact_kern.hpp"
#include "kernels/dem/pair_law_kern.hpp"
#include "kernels/dem/ray_field_kern.hpp"
#include "kernels/dem/sphere_contact_kern.hpp"

// The item function of a substep's body contacts; body_contact.cpp and body_contact.cu bring in the schedule.
namespace tread::dem::body_contact
{

/// What a pair's nodes and its answer have in common.
struct PairSetting
{
    Couple         couple; ///< of a pair of bodies; against a wall only the first
    PairLaw        law;
    RelativeMotion motion;
    Vec3<double>   arm;  ///< m, centre of b relative to that of a; zero against a wall
    const Plane*   wall; ///< null between bodies
};

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
        PairSetting setting;
        set_all(p, setting);
        Patch              patch    = pairs.patch[p];
        const PairResponse response = answer(p, setting, sum_nodes(p, setting), patch);
        pairs.patch[p]              = patch;
        pairs.response[p]           = response;
        pairs.peak[p]               = std::fmax(pairs.peak[p], response.overlap);
    }

    TREAD_HD void set_all(std::int64_t p, PairSetting& setting) const
    {
        set_pair(p, setting);
        if (pairs.first_node[p] == pairs.first_node[p + 1]) { return; } // exact spheres need no more
        for (int body = 0; body < (setting.wall != nullptr ? 1 : 2); ++body) { set_body(p, body, setting); }
    }

    /// All of a setting but its bodies.
    TREAD_HD void set_pair(std::int64_t p, PairSetting& setting) const
    {
        const std::int64_t a = first_of(pairs.key[p]), b = second_of(pairs.key[p]);
        setting.law    = law_of(bodies, law, pairs.key[p]);
        setting.motion = {bodies.velocity[a], bodies.angular_velocity[a]};
        setting.arm    = Vec3<double>::Zero();
        setting.wall   = b < bodies.count ? nullptr : law.planes + (b - bodies.count);
        if (b >= bodies.count) { return; }
        const Vec3<double> spin = bodies.angular_velocity[b];
        setting.arm             = bodies.position[b] - bodies.position[a];
        setting.motion.velocity += spin.cross(setting.arm) - bodies.velocity[b];
        setting.motion.spin -= spin;
    }

    /// Its first (0) or second (1) body.
    TREAD_HD void set_body(std::int64_t p, int body, PairSetting& setting) const
    {
        const std::int64_t a = first_of(pairs.key[p]), b = second_of(pairs.key[p]);
        setting.couple.body[body] = instance_of(bodies, law.templates, body == 0 ? a : b, bodies.position[a]);
    }

    /// A node of the pair's list at its place in the other side's field.
    TREAD_HD NodeInField look_up(std::int64_t p, const PairSetting& setting, std::int32_t node) const
    {
        if (setting.wall == nullptr) { return TwoSides<Meet>{meet, setting.couple}(node); }
        const PlaneField plane = field_of(*setting.wall, bodies.position[first_of(pairs.key[p])]);
        return OneSide{{setting.couple.body[0], plane, 1.0, 1.0}}(node);
    }

    TREAD_HD static double stiffening(const PairSetting& setting, const NodeInField& node)
    {
        return setting.wall == nullptr ? Meet::stiffening(node) : 1.0;
    }

    /// The pair's answer; updates its record.
    TREAD_HD PairResponse answer(std::int64_t p, const PairSetting& setting, NodeSums sums, Patch& patch) const
    {
        const std::int64_t a = first_of(pairs.key[p]), b = second_of(pairs.key[p]);
        if (exact_radius(a) > 0 && (b >= bodies.count || exact_radius(b) > 0))
        {
            sums = sums_of_spheres(setting.law, touch_of(a, b, setting), setting.motion);
        }
        if (!(sums.stiffness.overlap > 0)) { return release(setting.law, patch); }
        const Spins spins{bodies.angular_velocity[a], bodies.angular_velocity[a] - setting.motion.spin};
        return respond(setting.law, sums, setting.motion, spins, setting.arm, patch, dt);
    }

private:
    /// m; 0 of a body that is no exact sphere.
    TREAD_HD double exact_radius(std::int64_t b) const
    {
        return bodies.scale[b] * law.templates[bodies.shape[b]].sphere_radius;
    }

    TREAD_HD SphereContact touch_of(std::int64_t a, std::int64_t b, const PairSetting& setting) const
    {
        return setting.wall == nullptr
                   ? contact_of_spheres(exact_radius(a), exact_radius(b), setting.arm)
                   : contact_with_plane(exact_radius(a), field_of(*setting.wall, bodies.position[a]));
    }

    TREAD_HD NodeSums sum_nodes(std::int64_t p, const PairSetting& setting) const
    {
        NodeSums   sums = no_nodes();
        const auto each = [&](auto visit)
        {
            for (std::int32_t i = pairs.first_node[p]; i < pairs.first_node[p + 1]; ++i)
            {
                const NodeInField node = look_up(p, setting, pairs.node[i]);
                if (node.overlap > 0) { visit(node); }
            }
        };
        each([&](const NodeInField& node)
             { add_stiffness(setting.law, node, stiffening(setting, node), sums.stiffness); });
        if (!(sums.stiffness.overlap > 0)) { return sums; }
        const double relaxation = relaxation_time(setting.law, sums.stiffness.sum);
        each([&](const NodeInField& node) { add_node(setting.law, node, setting.motion, relaxation, sums.patch); });
        return sums;
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
