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

/// Adds the pairs of one body in the order of the list: first those in which it comes first.
struct GatherBody
{
    BodiesView bodies;
    PairsView  pairs;
    BodyTotal* totals;
    double     dt;

    template<class Lanes>
    TREAD_HD void operator()(std::int64_t b, const Lanes& lanes) const
    {
        BodyShare share{Vec3<double>::Zero(), Vec3<double>::Zero(), 0, Vec3<double>::Zero(), 0, 0};
        for (std::int64_t p = pairs.first[b] + lanes.lane(); p < pairs.first[b + 1]; p += lanes.lanes())
        {
            add_first(p, share);
        }
        for (std::int64_t i = pairs.second[b] + lanes.lane(); i < pairs.second[b + 1]; i += lanes.lanes())
        {
            share.force += pairs.answers.second_force[i];
            share.torque += pairs.answers.second_torque[i];
            share.stiffness += pairs.answers.second_stiffness[i];
        }
        share.reduce(lanes);
        if (lanes.lane() == 0) { store(b, share); }
    }

    TREAD_HD void add_first(std::int64_t p, BodyShare& share) const
    {
        const Vec3<double> force = pairs.answers.force[p];
        share.force += force;
        share.torque += pairs.answers.torque[p];
        share.stiffness += pairs.answers.stiffness[p];
        share.friction += pairs.answers.friction[p];
        share.restitution += pairs.answers.restitution[p];
        if (second_of(pairs.key[p]) >= bodies.count) { share.wall_force += force; }
    }

    TREAD_HD void store(std::int64_t b, const BodyShare& share) const
    {
        const bool sand     = bodies.sand_force != nullptr;
        bodies.force[b]     = sand ? Vec3<double>(bodies.force[b] + share.force) : share.force;
        bodies.torque[b]    = sand ? Vec3<double>(bodies.torque[b] + share.torque) : share.torque;
        bodies.stiffness[b] = share.stiffness + (sand ? bodies.stiffness[b] : 0.0);
        if (share.wall_force.squaredNorm() > 0) { totals[b].wall_impulse += dt * share.wall_force; }
        if (share.friction != 0) { totals[b].friction += share.friction; }
        if (share.restitution != 0) { totals[b].restitution += share.restitution; }
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
        if (is_large[b] == 0) { gather(b, lanes); }
        if (lanes.lane() != 0) { return; }
        if (b < named.count) { impulse_steps::Add{gather.bodies, named.impulse, gather.dt}(b); }
        integrate(b);
        show(b);
    }

private:
    /// To the contacts of the next substep.
    TREAD_HD void show(std::int64_t b) const
    {
        const BodiesView& bodies = gather.bodies;
        ContactBody&      body   = gather.pairs.body[b];
        body.position            = bodies.position[b];
        body.orientation         = bodies.orientation[b];
        body.velocity            = bodies.velocity[b];
        body.spin                = bodies.angular_velocity[b];
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
