#pragma once

#include "backend/bits.hpp"
#include "kernels/dem/contact/body_contact.hpp"
#include "kernels/dem/contact/body_contact_kern.hpp"
#include "kernels/dem/contact/pair_law_kern.hpp"
#include "kernels/dem/contact/ray_field_kern.hpp"
#include "kernels/dem/contact/sphere_contact_kern.hpp"

// Item function of the body contacts of a substep; body_contact.cpp and body_contact.cu provide the schedule.
namespace tread::dem::body_contact
{

/// Data shared by a pair's nodes and its response.
struct PairSetting
{
    PairLaw        law;
    RelativeMotion motion;
    Vec3<double>   arm;       ///< m, centre of b relative to that of a, world frame; zero against a wall
    Vec3<double>   spin;      ///< rad/s, of a
    double         radius[2]; ///< m, of exact spheres; 0 for other bodies and for a wall
    const Plane*   wall;      ///< null for two bodies
};

/// Returns the radius of an exact sphere, m; 0 for other bodies.
TREAD_HD double exact_radius(const BodyLaw& law, const ContactBody& body)
{
    return body.scale * law.templates[body.shape].sphere_radius;
}

/// Makes the data of a pair; `bodies` = number of bodies.
TREAD_HD PairSetting setting_of(const PairsView& pairs, const BodyLaw& law, std::int64_t bodies, std::uint64_t key)
{
    const std::int64_t second = second_of(key);
    const ContactBody  a      = load(pairs.body + first_of(key));
    const LawSide      side   = side_of(a, law.templates);
    if (second >= bodies)
    {
        const Plane* wall = law.planes + (second - bodies);
        return {law_against(law, side, *wall), {a.velocity, a.spin},
                Vec3<double>::Zero(),          a.spin,
                {exact_radius(law, a), 0},     wall};
    }
    const ContactBody  b   = load(pairs.body + second);
    const Vec3<double> arm = b.position - a.position;
    return {law_between(law, side, side_of(b, law.templates)),
            {a.velocity + (b.spin.cross(arm) - b.velocity), a.spin - b.spin},
            arm,
            a.spin,
            {exact_radius(law, a), exact_radius(law, b)},
            nullptr};
}

/// Computes the response of a pair from its nodes, which must have been checked (contact_nodes.hpp), by lanes that
/// share it. Meet: narrow phase, MeetByDistance or MeetByRays.
template<class Meet>
struct AnswerPair
{
    Meet         meet;
    std::int64_t bodies; ///< number of bodies
    BodyLaw      law;
    PairsView    pairs;
    double       dt;

    template<class Lanes>
    TREAD_HD void operator()(std::int64_t p, const Lanes& lanes) const
    {
        const PairSetting setting = setting_of(pairs, law, bodies, pairs.key[p]);
        const NodeSums    sums    = of_spheres(setting) ? touch_spheres(p, setting) : sum_nodes(p, setting, lanes);
        if (lanes.lane() != 0) { return; }
        const double       peak     = pairs.peak[p]; // all reads come before any write, so that the loads overlap
        const std::int32_t place    = pairs.answers.place[p];
        Patch              patch    = pairs.patch[p];
        const PairResponse response = answer(setting, sums, patch);
        pairs.answers.store(p, place, response);
        pairs.peak[p]  = std::fmax(peak, response.overlap);
        pairs.patch[p] = patch;
    }

private:
    TREAD_HD static bool of_spheres(const PairSetting& setting)
    {
        return setting.radius[0] > 0 && (setting.wall != nullptr || setting.radius[1] > 0);
    }

    /// Returns the sums of exact spheres, which have a closed form instead of nodes.
    TREAD_HD NodeSums touch_spheres(std::int64_t p, const PairSetting& setting) const
    {
        const SphereContact contact =
            setting.wall == nullptr
                ? contact_of_spheres(setting.radius[0], setting.radius[1], setting.arm)
                : contact_with_plane(setting.radius[0],
                                     field_of(*setting.wall, pairs.body[first_of(pairs.key[p])].position));
        return sums_of_spheres(setting.law, contact, setting.motion);
    }

    /// Computes the pair's response and updates its record.
    TREAD_HD PairResponse answer(const PairSetting& setting, const NodeSums& sums, Patch& patch) const
    {
        if (!(sums.stiffness.overlap > 0)) { return release(setting.law, patch); }
        const Spins spins{setting.spin, setting.spin - setting.motion.spin};
        return respond(setting.law, sums, setting.motion, spins, setting.arm, patch, dt);
    }

    /// Calls visit for the lane's nodes that are inside, in the order of the list.
    template<class Lanes, class Visit>
    TREAD_HD void each_inside(std::int64_t p, const Lanes& lanes, Visit visit) const
    {
        const std::int32_t end = pairs.first_node[p + 1];
        for (std::int32_t base = pairs.first_node[p]; base < end; base += nodes_of_word)
        {
            std::uint32_t left = lanes.share(inside_from(base) & first_bits(end - base));
            for (; left != 0; left &= left - 1) { visit(unpacked(pairs.found_node[base + lowest_bit(left)])); }
        }
    }

    /// Returns the mask of nodes that are inside; bit i: node `base` + i.
    TREAD_HD std::uint32_t inside_from(std::int32_t base) const
    {
        const std::uint32_t* word = pairs.inside + base / nodes_of_word;
        const std::uint64_t  both = std::uint64_t{word[1]} << nodes_of_word | word[0];
        return static_cast<std::uint32_t>(both >> base % nodes_of_word);
    }

    template<class Lanes>
    TREAD_HD NodeSums sum_nodes(std::int64_t p, const PairSetting& setting, const Lanes& lanes) const
    {
        NodeSums sums = no_nodes();
        each_inside(p, lanes,
                    [&](const NodeInField& node)
                    {
                        const double stiffening = setting.wall == nullptr ? Meet::stiffening(node) : 1.0;
                        add_stiffness(setting.law, node, stiffening, sums.stiffness);
                    });
        sums.stiffness = {lanes.sum(sums.stiffness.sum), lanes.largest(sums.stiffness.overlap)};
        if (!(sums.stiffness.overlap > 0)) { return sums; }
        const double relaxation = relaxation_time(setting.law, sums.stiffness.sum);
        each_inside(p, lanes,
                    [&](const NodeInField& node)
                    { add_node(setting.law, node, setting.motion, relaxation, sums.patch); });
        sums.patch.reduce(lanes);
        return sums;
    }
};

/// Rolling resistance, in a separate launch and only in scenes that have it.
struct ResistRolling
{
    std::int64_t bodies; ///< number of bodies
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
