#pragma once

#include "kernels/dem/motion/move_impl.hpp"
#include "kernels/dem/pairs/pairs_kern.hpp"

// Item functions of sleep.hpp: what holds sleepers, and what they weigh.
namespace tread::dem::sleeping
{

/// Stops a tired body. Velocities are those of half a substep earlier, as where commands change them.
struct StopBody
{
    BodiesView          bodies;
    const std::int32_t* mark;
    BodyTotal*          totals;
    double              substep; ///< s
    Vec3<double>        gravity; ///< m/s2

    TREAD_HD void operator()(std::int64_t b) const
    {
        if (mark[b] != mark_tired) { return; }
        const Mat3<double> rotation = bodies.orientation[b].toRotationMatrix();
        const Vec3<double> spin     = rotation.transpose() * bodies.angular_velocity[b];
        const Vec3<double> momentum = bodies.mass[b] * bodies.velocity[b];
        const double kinetic = 0.5 * (momentum.dot(bodies.velocity[b]) + spin.dot(full(bodies.inertia[b]) * spin));
        if (bodies.is_owned(b))
        {
            totals[b].holding_impulse -= momentum;
            totals[b].holding_work -= kinetic + 0.5 * substep * gravity.dot(momentum);
        }
        bodies.velocity[b]         = Vec3<double>::Zero();
        bodies.angular_velocity[b] = Vec3<double>::Zero();
        bodies.asleep[b]           = 1;
    }
};

/// Accounts for the friction of contacts that were computed once more at rest.
struct BookFriction
{
    std::int64_t bodies;
    PairsView    pairs;
    BodyTotal*   totals;

    TREAD_HD void operator()(std::int64_t b) const
    {
        double friction = 0;
        for (std::int32_t p = pairs.first[b]; p < pairs.first[b + 1]; ++p) { friction += pairs.answers.friction[p]; }
        if (friction != 0) { totals[b].friction += friction; }
    }
};

/// Sums the listed contacts of a body: `pairs`.force is their sum, and `pairs`.stiffness that of their magnitudes, N.
struct SumLoads
{
    PairsView pairs;

    TREAD_HD ContactWrench operator()(std::int64_t b) const
    {
        ContactWrench sum = ContactWrench::zero();
        for (std::int32_t p = pairs.first[b]; p < pairs.first[b + 1]; ++p) { add(pairs.answers.force[p], sum); }
        for (std::int32_t i = pairs.second[b]; i < pairs.second[b + 1]; ++i)
        {
            add(pairs.answers.second_force[i], sum);
        }
        return sum;
    }

private:
    TREAD_HD static void add(const Vec3<double>& force, ContactWrench& sum)
    {
        sum.force += force;
        sum.stiffness += force.norm();
    }
};

/// Begins the watch over the load of a body that has just fallen asleep. What it carries is half the sum of all forces
/// that hold it in balance: for a rock on a floor its weight.
struct BeginWatch
{
    BodiesView    bodies;
    SumLoads      loads;
    SharedView    shared;
    double        share; ///< of the carried load, for the limit
    Vec3<double>  gravity;
    SleepWatch*   watch;
    std::int32_t* mark;

    TREAD_HD void operator()(std::int64_t b) const
    {
        if (mark[b] != mark_tired) { return; }
        mark[b]                     = mark_none;
        const ContactWrench between = shared.is_shared(b) ? wrench_of(shared, shared.place[b]).pairs : loads(b);
        const double        of_sand = (bodies.force[b] - between.force).norm();
        const double        carried = bodies.mass[b] * gravity.norm() + between.stiffness + of_sand;
        const Vec3<double>  zero    = Vec3<double>::Zero();
        watch[b] = {ContactWrench::zero(), zero, zero, zero, zero, zero, zero, 0.5 * share * carried, 0};
    }
};

/// Writes this rank's share of a sum over the contacts of each shared body. Sum: SumLoads or SumHeld.
template<class Sum>
struct ShareSum
{
    SharedView shared;
    Sum        sum;

    TREAD_HD void operator()(std::int64_t i) const { shared.wrench[i] = {ContactWrench::zero(), sum(shared.body[i])}; }
};

/// Sums the contacts of a sleeper with other sleepers, walls and sleeping sand.
struct SumHeld
{
    BodiesView           bodies;
    SleepingPairsView    pairs;
    const ContactWrench* sand; ///< null if no sand sleeps beside bodies

    TREAD_HD ContactWrench operator()(std::int64_t b) const
    {
        ContactWrench sum = sand != nullptr ? sand[b] : ContactWrench::zero();
        for (std::int32_t p = pairs.first[b]; p < pairs.first[b + 1]; ++p)
        {
            const HeldContact& contact = pairs.contact[p];
            sum                        = sum + ContactWrench{contact.force, contact.torque_a, contact.stiffness};
        }
        for (std::int32_t i = pairs.second[b]; i < pairs.second[b + 1]; ++i)
        {
            const HeldContact& contact = pairs.contact[pairs.by_second[i]];
            sum                        = sum + ContactWrench{-contact.force, contact.torque_b, contact.stiffness};
        }
        return sum;
    }
};

struct HoldBody
{
    BodiesView  bodies;
    SumHeld     all;
    SharedView  shared;
    double      held; ///< s, for which the last sum was held
    SleepWatch* watch;

    TREAD_HD void operator()(std::int64_t b) const
    {
        if (!bodies.is_asleep(b)) { return; }
        const ContactWrench sum = shared.is_shared(b) ? wrench_of(shared, shared.place[b]).pairs : all(b);
        watch[b].impulse += held * watch[b].held.force;
        watch[b].angular_impulse += held * watch[b].held.torque;
        watch[b].held       = sum;
        bodies.force[b]     = sum.force;
        bodies.torque[b]    = sum.torque;
        bodies.stiffness[b] = sum.stiffness;
    }
};

/// Whether the substeps compute a body. What touches a shared sleeper may be on another rank.
struct IsMoved
{
    BodiesView      bodies;
    PairsView       pairs;
    OutsideWrenches outside;
    SharedView      shared;

    TREAD_HD bool operator()(std::int64_t b) const
    {
        return !bodies.is_asleep(b) || shared.is_shared(b) || pairs.first[b] < pairs.first[b + 1] ||
               pairs.second[b] < pairs.second[b + 1] || (outside.run != nullptr && outside.run[b] >= 0);
    }
};

/// Number and mass of sleepers.
struct SleepersSum
{
    double count;
    double mass; ///< kg
};

struct WriteSleeper
{
    BodiesView bodies;
    double*    rows; ///< SleepersSum of each body

    TREAD_HD void operator()(std::int64_t b) const
    {
        const bool sleeps = bodies.is_asleep(b) && bodies.is_owned(b);
        rows[2 * b]       = sleeps ? 1 : 0;
        rows[2 * b + 1]   = sleeps ? bodies.mass[b] : 0.0;
    }
};

struct WriteEnergy
{
    SleepingPairsView pairs;
    double*           energy;

    TREAD_HD void operator()(std::int64_t p) const { energy[p] = pairs.contact[p].energy; }
};

} // namespace tread::dem::sleeping
