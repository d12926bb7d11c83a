#pragma once

#include "kernels/dem/body_contact_kern.hpp"
#include "kernels/dem/impulses_impl.hpp"
#include "kernels/dem/integrate_impl.hpp"
#include "kernels/dem/move.hpp"

// The item functions of move.hpp; move.cpp and move.cu bring in the schedule.
namespace tread::dem::moving
{

/// What the contacts do to one body.
struct BodyShare
{
    Vec3<double> force;
    Vec3<double> torque;
    double       stiffness;
    Vec3<double> wall_force;
    double       friction;
    double       restitution;

    template<class Lanes>
    TREAD_HD void reduce(const Lanes& lanes)
    {
        for (int c = 0; c < 3; ++c)
        {
            force[c]      = lanes.sum(force[c]);
            torque[c]     = lanes.sum(torque[c]);
            wall_force[c] = lanes.sum(wall_force[c]);
        }
        stiffness   = lanes.sum(stiffness);
        friction    = lanes.sum(friction);
        restitution = lanes.sum(restitution);
    }
};

/// Adds the pairs of one body in the order of the list, those in which it comes first and those in which it comes
/// second side by side: memory then answers both at a time. Of the lanes that share a body the first one writes, and
/// gets what all its contacts do to it.
struct GatherBody
{
    BodiesView bodies;
    PairsView  pairs;
    BodyTotal* totals;
    double     dt;

    template<class Lanes>
    TREAD_HD Wrench operator()(std::int64_t b, const Lanes& lanes) const
    {
        BodyShare          share{Vec3<double>::Zero(), Vec3<double>::Zero(), 0, Vec3<double>::Zero(), 0, 0};
        const std::int64_t first_end = pairs.first[b + 1], second_end = pairs.second[b + 1];
        for (std::int64_t p = pairs.first[b] + lanes.lane(), i = pairs.second[b] + lanes.lane();
             p < first_end || i < second_end; p += lanes.lanes(), i += lanes.lanes())
        {
            add_first(p < first_end, p, share);
            add_second(i < second_end, i, share);
        }
        share.reduce(lanes);
        return lanes.lane() == 0 ? store(b, share) : Wrench{};
    }

private:
    // Zero is chosen where there is no pair, after row 0, which is always there, was read: no load waits for a branch.
    TREAD_HD static double       chosen(bool there, double value) { return there ? value : 0.0; }
    TREAD_HD static Vec3<double> chosen(bool there, const Vec3<double>& value)
    {
        return {chosen(there, value[0]), chosen(there, value[1]), chosen(there, value[2])};
    }

    TREAD_HD void add_first(bool there, std::int64_t pair, BodyShare& share) const
    {
        const std::int64_t p     = there ? pair : 0;
        const bool         wall  = second_of(pairs.key[p]) >= bodies.count;
        const Vec3<double> force = chosen(there, pairs.answers.force[p]);
        share.force += force;
        share.torque += chosen(there, pairs.answers.torque[p]);
        share.stiffness += chosen(there, pairs.answers.stiffness[p]);
        share.friction += chosen(there, pairs.answers.friction[p]);
        share.restitution += chosen(there, pairs.answers.restitution[p]);
        share.wall_force += chosen(wall, force);
    }

    TREAD_HD void add_second(bool there, std::int64_t place, BodyShare& share) const
    {
        const std::int64_t i = there ? place : 0;
        share.force += chosen(there, pairs.answers.second_force[i]);
        share.torque += chosen(there, pairs.answers.second_torque[i]);
        share.stiffness += chosen(there, pairs.answers.second_stiffness[i]);
    }

    TREAD_HD Wrench store(std::int64_t b, const BodyShare& share) const
    {
        Wrench wrench{share.force, share.torque};
        double stiffness = share.stiffness;
        if (bodies.sand_force != nullptr)
        {
            wrench.force += bodies.force[b];
            wrench.torque += bodies.torque[b];
            stiffness += bodies.stiffness[b];
        }
        bodies.force[b]     = wrench.force;
        bodies.torque[b]    = wrench.torque;
        bodies.stiffness[b] = stiffness;
        if (share.wall_force.squaredNorm() > 0) { totals[b].wall_impulse += dt * share.wall_force; }
        if (share.friction != 0) { totals[b].friction += share.friction; }
        if (share.restitution != 0) { totals[b].restitution += share.restitution; }
        return wrench;
    }
};

/// A large body's own launch, by many lanes: it may have thousands of pairs.
struct GatherLarge
{
    GatherBody          gather;
    const std::int32_t* large;

    template<class Lanes>
    TREAD_HD void operator()(std::int64_t l, const Lanes& lanes) const
    {
        gather(large[l], lanes);
    }
};

/// Gathers, books the impulse of a named body, and moves the body by integration::Free or integration::Damped.
template<class Integrate>
struct Move
{
    GatherBody          gather;
    const std::int32_t* is_large;
    NamedImpulses       named;
    Integrate           integrate;

    template<class Lanes>
    TREAD_HD void operator()(std::int64_t b, const Lanes& lanes) const
    {
        const BodiesView& bodies  = gather.bodies;
        ContactBody       shown   = load(gather.pairs.body + b);
        BodyMotion        body    = motion_of(bodies, b);
        const Wrench      contact = is_large[b] == 0 ? gather(b, lanes) : Wrench{bodies.force[b], bodies.torque[b]};
        if (lanes.lane() != 0) { return; }
        if (b < named.count) { impulse_steps::Add{bodies, named.impulse, gather.dt}(b); }
        integrate(b, body, contact);
        store_motion(bodies, b, body);
        show(body, shown);
        store(gather.pairs.body + b, shown);
    }

private:
    /// To the contacts of the next substep.
    TREAD_HD static void show(const BodyMotion& body, ContactBody& shown)
    {
        shown.position    = body.position;
        shown.orientation = body.orientation;
        shown.velocity    = body.velocity;
        shown.spin        = body.angular_velocity;
    }
};

/// Calls run with the Move that the motion asks for.
template<class Run>
void with_move(const GatherBody& gather, const std::int32_t* is_large, const NamedImpulses& named, const Motion& motion,
               Run run)
{
    if (motion.damping > 0)
    {
        run(Move<integration::Damped>{
            gather, is_large, named, {gather.bodies, gather.totals, motion.gravity, motion.damping, motion.dt}});
    }
    else
    {
        run(Move<integration::Free>{
            gather, is_large, named, {gather.bodies, gather.totals, motion.gravity, motion.dt}});
    }
}

} // namespace tread::dem::moving
