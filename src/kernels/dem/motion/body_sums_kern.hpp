#pragma once

#include "kernels/dem/motion/outside.hpp"
#include "kernels/dem/pairs/pairs.hpp"

// Sums of what acts on one body: its pairs, and what acts from outside.
namespace tread::dem::moving
{

/// Sums over the pairs of one body.
struct BodyShare
{
    ContactWrench contact;
    Vec3<double>  wall_force;
    double        friction;
    double        restitution;

    TREAD_HD static BodyShare zero() { return {ContactWrench::zero(), Vec3<double>::Zero(), 0, 0}; }
};

/// Sums over the lanes that share a body.
template<class Lanes>
TREAD_HD void reduce(Vec3<double>& value, const Lanes& lanes)
{
    for (int c = 0; c < 3; ++c) { value[c] = lanes.sum(value[c]); }
}

template<class Lanes>
TREAD_HD void reduce(ContactWrench& wrench, const Lanes& lanes)
{
    reduce(wrench.force, lanes);
    reduce(wrench.torque, lanes);
    wrench.stiffness = lanes.sum(wrench.stiffness);
}

template<class Lanes>
TREAD_HD void reduce(BodyShare& share, const Lanes& lanes)
{
    reduce(share.contact, lanes);
    reduce(share.wall_force, lanes);
    share.friction    = lanes.sum(share.friction);
    share.restitution = lanes.sum(share.restitution);
}

/// Adds the pairs of one body in the order of the list. Pairs in which it is first and pairs in which it is second are
/// read in the same iteration, so that the loads overlap.
struct GatherPairs
{
    PairsView    pairs;
    std::int64_t bodies; ///< number of bodies

    template<class Lanes>
    TREAD_HD BodyShare operator()(std::int64_t b, const Lanes& lanes) const
    {
        BodyShare          share     = BodyShare::zero();
        const std::int64_t first_end = pairs.first[b + 1], second_end = pairs.second[b + 1];
        for (std::int64_t p = pairs.first[b] + lanes.lane(), i = pairs.second[b] + lanes.lane();
             p < first_end || i < second_end; p += lanes.lanes(), i += lanes.lanes())
        {
            add_first(p < first_end, p, share);
            add_second(i < second_end, i, share);
        }
        reduce(share, lanes);
        return share;
    }

private:
    // Selects 0 if there is no pair, after reading row 0, which always exists: loads do not wait for a branch.
    TREAD_HD static double       chosen(bool there, double value) { return there ? value : 0.0; }
    TREAD_HD static Vec3<double> chosen(bool there, const Vec3<double>& value)
    {
        return {chosen(there, value[0]), chosen(there, value[1]), chosen(there, value[2])};
    }

    TREAD_HD void add_first(bool there, std::int64_t pair, BodyShare& share) const
    {
        const std::int64_t p     = there ? pair : 0;
        const bool         wall  = second_of(pairs.key[p]) >= bodies;
        const Vec3<double> force = chosen(there, pairs.answers.force[p]);
        share.contact.force += force;
        share.contact.torque += chosen(there, pairs.answers.torque[p]);
        share.contact.stiffness += chosen(there, pairs.answers.stiffness[p]);
        share.friction += chosen(there, pairs.answers.friction[p]);
        share.restitution += chosen(there, pairs.answers.restitution[p]);
        share.wall_force += chosen(wall, force);
    }

    TREAD_HD void add_second(bool there, std::int64_t place, BodyShare& share) const
    {
        const std::int64_t i = there ? place : 0;
        share.contact.force += chosen(there, pairs.answers.second_force[i]);
        share.contact.torque += chosen(there, pairs.answers.second_torque[i]);
        share.contact.stiffness += chosen(there, pairs.answers.second_stiffness[i]);
    }
};

/// No external wrenches on bodies.
struct NothingOutside
{
    static constexpr bool acts = false;

    template<class Lanes>
    TREAD_HD ContactWrench operator()(std::int64_t, const Lanes&) const
    {
        return ContactWrench::zero();
    }
};

/// Sums the external wrenches.
struct SumOutside
{
    static constexpr bool acts = true;

    OutsideWrenches wrenches;

    template<class Lanes>
    TREAD_HD ContactWrench operator()(std::int64_t b, const Lanes& lanes) const
    {
        ContactWrench      sum = ContactWrench::zero();
        const std::int32_t run = wrenches.run == nullptr ? -1 : wrenches.run[b];
        if (run < 0) { return sum; }
        const std::int32_t end = wrenches.first[run + 1];
        for (std::int32_t i = wrenches.first[run] + lanes.lane(); i < end; i += lanes.lanes())
        {
            sum = sum + wrenches.part[i];
        }
        reduce(sum, lanes);
        return sum;
    }
};

} // namespace tread::dem::moving
