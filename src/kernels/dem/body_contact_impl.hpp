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
    PairLaw        law;
    RelativeMotion motion;
    Vec3<double>   arm;  ///< m, centre of b relative to that of a; zero against a wall
    const Plane*   wall; ///< null between bodies
};

/// `bodies` = how many there are.
TREAD_HD const Plane* wall_of(const BodyLaw& law, std::int64_t bodies, std::uint64_t key)
{
    const std::int64_t b = second_of(key);
    return b < bodies ? nullptr : law.planes + (b - bodies);
}

TREAD_HD PairSetting setting_of(const PairsView& pairs, const BodyLaw& law, std::int64_t bodies, std::uint64_t key)
{
    const ContactBody a    = load(pairs.body + first_of(key));
    const LawSide     side = side_of(a, law.templates);
    const Plane*      wall = wall_of(law, bodies, key);
    if (wall != nullptr) { return {law_against(law, side, *wall), {a.velocity, a.spin}, Vec3<double>::Zero(), wall}; }
    const ContactBody  b   = load(pairs.body + second_of(key));
    const Vec3<double> arm = b.position - a.position;
    return {law_between(law, side, side_of(b, law.templates)),
            {a.velocity + (b.spin.cross(arm) - b.velocity), a.spin - b.spin},
            arm,
            nullptr};
}

/// Answers a pair when its nodes were looked up (contact_nodes.hpp). Meet: how two bodies see each other,
/// MeetByDistance or MeetByRays.
template<class Meet>
struct AnswerPair
{
    Meet         meet;
    std::int64_t bodies; ///< how many
    BodyLaw      law;
    PairsView    pairs;
    double       dt;

    TREAD_HD void operator()(std::int64_t p) const
    {
        const PairSetting setting = setting_of(pairs, law, bodies, pairs.key[p]);
        Patch             patch   = pairs.patch[p];
        NodeSums          sums    = sum_nodes(p, setting);
        touch_spheres(p, setting, sums);
        write(p, answer(p, setting, sums, patch));
        pairs.patch[p] = patch;
    }

    TREAD_HD void write(std::int64_t p, const PairResponse& response) const
    {
        pairs.answers.store(p, response);
        pairs.peak[p] = std::fmax(pairs.peak[p], response.overlap);
    }

    /// Exact spheres have a closed form instead of nodes.
    TREAD_HD void touch_spheres(std::int64_t p, const PairSetting& setting, NodeSums& sums) const
    {
        const std::int64_t a = first_of(pairs.key[p]), b = second_of(pairs.key[p]);
        if (exact_radius(a) > 0 && (setting.wall != nullptr || exact_radius(b) > 0))
        {
            sums = sums_of_spheres(setting.law, touch_of(a, b, setting), setting.motion);
        }
    }

    /// The pair's answer; updates its record.
    TREAD_HD PairResponse answer(std::int64_t p, const PairSetting& setting, const NodeSums& sums, Patch& patch) const
    {
        if (!(sums.stiffness.overlap > 0)) { return release(setting.law, patch); }
        const Vec3<double> spin = pairs.body[first_of(pairs.key[p])].spin;
        const Spins        spins{spin, spin - setting.motion.spin};
        return respond(setting.law, sums, setting.motion, spins, setting.arm, patch, dt);
    }

private:
    TREAD_HD NodeSums sum_nodes(std::int64_t p, const PairSetting& setting) const
    {
        NodeSums   sums = no_nodes();
        const auto each = [&](auto visit)
        {
            for (std::int32_t i = pairs.first_node[p]; i < pairs.first_node[p + 1]; ++i)
            {
                const NodeInField node = unpacked(pairs.found_node[i]);
                if (node.overlap > 0) { visit(node); }
            }
        };
        each(
            [&](const NodeInField& node)
            {
                const double stiffening = setting.wall == nullptr ? Meet::stiffening(node) : 1.0;
                add_stiffness(setting.law, node, stiffening, sums.stiffness);
            });
        if (!(sums.stiffness.overlap > 0)) { return sums; }
        const double relaxation = relaxation_time(setting.law, sums.stiffness.sum);
        each([&](const NodeInField& node) { add_node(setting.law, node, setting.motion, relaxation, sums.patch); });
        return sums;
    }

    /// m; 0 of a body that is no exact sphere.
    TREAD_HD double exact_radius(std::int64_t b) const
    {
        return pairs.body[b].scale * law.templates[pairs.body[b].shape].sphere_radius;
    }

    TREAD_HD SphereContact touch_of(std::int64_t a, std::int64_t b, const PairSetting& setting) const
    {
        return setting.wall == nullptr
                   ? contact_of_spheres(exact_radius(a), exact_radius(b), setting.arm)
                   : contact_with_plane(exact_radius(a), field_of(*setting.wall, pairs.body[a].position));
    }
};

/// A launch of its own, in scenes that have it.
struct ResistRolling
{
    std::int64_t bodies; ///< how many
    BodyLaw      law;
    PairsView    pairs;
    double       dt;

    TREAD_HD void operator()(std::int64_t p) const
    {
        const std::int64_t a = first_of(pairs.key[p]), b = second_of(pairs.key[p]);
        const bool         wall = b >= bodies;
        const PairLaw      pair = law_of(pairs, law, bodies, pairs.key[p]);
        const Spins        spins{pairs.body[a].spin, wall ? Vec3<double>::Zero() : pairs.body[b].spin};
        const Resistance   found = resist_rolling(pair, pairs.patch[p], pairs.answers.force[p],
                                                  pairs.answers.stiffness[p], spins, pairs.rolling[p], dt);
        pairs.answers.torque[p] += found.moment;
        pairs.answers.second_torque[pairs.answers.place[p]] -= found.moment;
        pairs.answers.energy[p] += found.energy;
        pairs.answers.friction[p] += found.lost;
    }
};

} // namespace tread::dem::body_contact
