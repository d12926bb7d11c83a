#pragma once

#include "kernels/dem/motion/body_sums_kern.hpp"
#include "kernels/dem/motion/integrate_kern.hpp"
#include "kernels/dem/motion/move.hpp"
#include "kernels/dem/motion/prescribed_kern.hpp"
#include "kernels/dem/pairs/displacement_kern.hpp"

// Item functions of move.hpp; move.cpp and move.cu provide the schedule.
namespace tread::dem::moving
{

/// No local damping.
struct Free
{
    TREAD_HD NoDamping operator()(const BodiesView&, std::int64_t) const { return {}; }
};

/// Local damping of the bodies that take part in it.
struct Damped
{
    double alpha;

    TREAD_HD LocalDamping operator()(const BodiesView& bodies, std::int64_t b) const
    {
        return {bodies.damped[b] != 0 ? alpha : 0.0};
    }
};

/// A single rank has all bodies.
struct Alone
{
    static constexpr bool of_several = false;
};

/// Several ranks integrate bodies, some of them together.
struct Together
{
    static constexpr bool of_several = true;

    SharedView shared;
};

/// No body of the scene has a prescribed motion.
struct NoMotions
{
    static constexpr bool act = false;
};

/// Some phase prescribes the motion of a body.
struct Motions
{
    static constexpr bool act = true;

    PrescribedView view;
};

/// Sums the forces on a body, adds them to its ledger, and moves it. Of the lanes that share it, the first one writes.
/// Damping: Free or Damped; Outside: NothingOutside or SumOutside; Ranks: Alone or Together; Prescription: NoMotions or
/// Motions.
template<class Damping, class Outside, class Ranks, class Prescription>
struct Move
{
    BodiesView     bodies;
    PairsView      pairs; ///< first = null: pairs were never found
    BodyTotal*     totals;
    NamedImpulses  named;
    JointWrenches  joints;
    SleepWatch*    watch;   ///< of each body; null: none may sleep
    Vec3<double>   gravity; ///< m/s2
    double         dt;      ///< s
    InertiaScaling scaling;
    Damping        damping;
    Outside        outside;
    Ranks          ranks;
    Prescription   prescription;

    DisplacementLimit limit;

    template<class Lanes>
    TREAD_HD void operator()(std::int64_t b, const Lanes& lanes) const
    {
        if constexpr (Ranks::of_several)
        {
            if (!bodies.is_here(b)) { return; }
        }
        // read before the sums, so that the loads overlap with them
        ContactBody     shown = pairs.body != nullptr ? load(pairs.body + b) : contact_body(bodies, b);
        BodyMotion      body  = motion_of(bodies, b, shown);
        const BodyShare share = pairs.first != nullptr ? GatherPairs{pairs, bodies.count}(b, lanes) : BodyShare::zero();
        const WrenchShare acting = of_all_ranks(b, {outside(b, lanes), share.contact});
        if (lanes.lane() != 0) { return; }
        const ContactWrench contact = acting.outside + acting.pairs;
        if (bodies.is_asleep(b))
        {
            hold(b, share, contact);
            return;
        }
        account_contacts(b, share, contact);
        BodyTotal        unused;
        const double     weight   = bodies.acting_weight(b, body.locked);
        const double     yielding = 1 / inertia_factor(b, body.mass, contact);
        const MeanMotion mean     = integrate(b, body, scaled(yielding, with_joints(b, contact)),
                                              yielding * weight * gravity, *total_of(b, unused));
        if (yielding != 1) { account_scaling(yielding - 1, body.mass, contact, mean, *total_of(b, unused)); }
        if (joints.place != nullptr) { account_joints(b, mean, *total_of(b, unused)); }
        if (weight != 1) { account_carried_weight((weight - 1) * body.mass * gravity, mean, *total_of(b, unused)); }
        if constexpr (Outside::acts) { account_outside(acting.outside, mean, *total_of(b, unused)); }
        store_motion(bodies, b, body);
        if (pairs.body != nullptr) { show(body, shown, pairs.body + b); }
        check_displacement_ahead(limit, bodies, b);
    }

private:
    /// Holds a sleeper at rest against `pull`, the wrench of awake bodies and sand.
    TREAD_HD void hold(std::int64_t b, const BodyShare& share, const ContactWrench& pull) const
    {
        SleepWatch& load = watch[b];
        account_contacts(b, share, pull + load.held);
        load.impulse += dt * pull.force;
        load.angular_impulse += dt * pull.torque;
        if (bodies.is_owned(b)) { totals[b].holding_impulse -= dt * pull.force; }
    }

    TREAD_HD MeanMotion integrate(std::int64_t b, BodyMotion& body, const ContactWrench& contact,
                                  const Vec3<double>& pull, BodyTotal& total) const
    {
        if constexpr (Prescription::act)
        {
            if ((body.locked & prescribed) != 0)
            {
                ContactImpulse reaction{Vec3<double>::Zero(), Vec3<double>::Zero()};
                MeanMotion     mean =
                    integrate_prescribed(prescription.view.motion[b], body, contact, pull, dt, total, reaction);
                if (bodies.is_owned(b)) { add(reaction, prescription.view.reaction[b]); }
                return mean;
            }
        }
        return integrate_body(body, contact, pull, damping(bodies, b), dt, total);
    }

    TREAD_HD static void add(const ContactImpulse& impulse, ContactImpulse& sum)
    {
        sum.linear += impulse.linear;
        sum.angular += impulse.angular;
    }

    TREAD_HD WrenchShare of_all_ranks(std::int64_t b, const WrenchShare& own) const
    {
        if constexpr (Ranks::of_several)
        {
            if (ranks.shared.is_shared(b)) { return wrench_of(ranks.shared, ranks.shared.place[b]); }
        }
        return own;
    }

    /// Returns the body's totals; the owner accounts for a ghost's motion. One call integrates both kinds, because a
    /// compiler may round two calls differently.
    TREAD_HD BodyTotal* total_of(std::int64_t b, BodyTotal& unused) const
    {
        if constexpr (Ranks::of_several)
        {
            if (!bodies.is_owned(b)) { return &unused; }
        }
        return totals + b;
    }

    TREAD_HD void account_contacts(std::int64_t b, const BodyShare& share, const ContactWrench& contact) const
    {
        bodies.force[b]     = contact.force;
        bodies.torque[b]    = contact.torque;
        bodies.stiffness[b] = contact.stiffness;
        if (share.wall_force.squaredNorm() > 0) { totals[b].wall_impulse += dt * share.wall_force; }
        if (share.friction != 0) { totals[b].friction += share.friction; }
        if (share.restitution != 0) { totals[b].restitution += share.restitution; }
        if (b < named.count && bodies.is_owned(b))
        {
            named.impulse[b].linear += dt * contact.force;
            named.impulse[b].angular += dt * contact.torque;
        }
    }

    TREAD_HD void account_outside(const ContactWrench& wrench, const MeanMotion& mean, BodyTotal& total) const
    {
        const double power = wrench.force.dot(mean.velocity) + wrench.torque.dot(mean.angular_velocity);
        if (power != 0) { total.sand_work += dt * power; }
    }

    TREAD_HD ContactWrench with_joints(std::int64_t b, const ContactWrench& contact) const
    {
        if (joints.place == nullptr || joints.place[b] < 0) { return contact; }
        const JointWrench& pull = joints.wrench[joints.place[b]];
        return {contact.force + pull.force, contact.torque + pull.torque, contact.stiffness};
    }

    /// Adds the impulse of joints, which is that of the world on the sum of all bodies, and the work of springs, motors
    /// and limits. Ties do no work: what they do by their error is left unaccounted.
    TREAD_HD void account_joints(std::int64_t b, const MeanMotion& mean, BodyTotal& total) const
    {
        if (joints.place[b] < 0) { return; }
        const JointWrench& pull = joints.wrench[joints.place[b]];
        total.holding_impulse += dt * pull.force;
        total.holding_work +=
            dt * (pull.working_force.dot(mean.velocity) + pull.working_torque.dot(mean.angular_velocity));
    }

    /// Returns the factor by which this substep scales a body's inertia; 1 for a named one.
    TREAD_HD double inertia_factor(std::int64_t b, double mass, const ContactWrench& contact) const
    {
        if (scaling.factor == nullptr || b < named.count) { return 1; }
        return scaling.renewed(b, mass, contact.stiffness);
    }

    TREAD_HD static ContactWrench scaled(double factor, const ContactWrench& wrench)
    {
        return {factor * wrench.force, factor * wrench.torque, wrench.stiffness};
    }

    /// Adds what scaled inertia takes of all that acts on a rock: `share` of it, negative.
    TREAD_HD void account_scaling(double share, double mass, const ContactWrench& contact, const MeanMotion& mean,
                                  BodyTotal& total) const
    {
        const Vec3<double> force = share * (contact.force + mass * gravity);
        total.holding_impulse += dt * force;
        total.scaling_work -= dt * (force.dot(mean.velocity) + share * contact.torque.dot(mean.angular_velocity));
    }

    /// Adds the work of the constraint that carries a share of the weight, as for locked degrees of freedom.
    TREAD_HD void account_carried_weight(const Vec3<double>& force, const MeanMotion& mean, BodyTotal& total) const
    {
        total.holding_impulse += dt * force;
        total.holding_work += dt * force.dot(mean.velocity);
    }

    /// Updates the record that the contacts of the next substep read.
    TREAD_HD static void show(const BodyMotion& body, ContactBody& shown, ContactBody* record)
    {
        shown.position    = body.position;
        shown.orientation = body.orientation;
        shown.velocity    = body.velocity;
        shown.spin        = body.angular_velocity;
        store(record, shown);
    }
};

/// Computes this rank's share of the wrench on a body that several ranks integrate.
struct ShareWrench
{
    PairsView    pairs;  ///< first = null: pairs were never found
    std::int64_t bodies; ///< number of bodies
    SumOutside   outside;
    SharedView   shared;

    template<class Lanes>
    TREAD_HD void operator()(std::int64_t i, const Lanes& lanes) const
    {
        const std::int64_t b     = shared.body[i];
        const BodyShare    share = pairs.first != nullptr ? GatherPairs{pairs, bodies}(b, lanes) : BodyShare::zero();
        const WrenchShare  own{outside(b, lanes), share.contact};
        if (lanes.lane() == 0) { shared.wrench[i] = own; }
    }
};

/// Makes the ShareWrench of the step.
template<class Exec>
ShareWrench make_share(const BodyStep<Exec>& step)
{
    return {step.pairs.view(), step.bodies.count, {step.motion.outside}, step.shared};
}

/// Makes the Move of the step.
template<class Exec, class Damping, class Outside, class Ranks, class Prescription>
Move<Damping, Outside, Ranks, Prescription> make_move(const BodyStep<Exec>& step, const Damping& damping,
                                                      const Outside& outside, const Ranks& ranks,
                                                      const Prescription& prescription)
{
    return {step.bodies,
            step.pairs.view(),
            step.totals,
            step.named,
            step.joints.wrenches(),
            step.pairs.sleep.watch.data(),
            step.motion.gravity,
            step.motion.dt,
            step.motion.scaling,
            damping,
            outside,
            ranks,
            prescription,
            step.limit};
}

/// Calls run with the Move of a scene without prescribed motions, for the damping.
template<class Exec, class Outside, class Ranks, class Run>
void without_motions(const BodyStep<Exec>& step, const Outside& outside, const Ranks& ranks, Run run)
{
    if (step.motion.damping > 0) { run(make_move(step, Damped{step.motion.damping}, outside, ranks, NoMotions{})); }
    else { run(make_move(step, Free{}, outside, ranks, NoMotions{})); }
}

/// Calls run with the Move for the damping and the prescribed motions. With motions one Move serves any damping.
template<class Exec, class Outside, class Ranks, class Run>
void with_motions(const BodyStep<Exec>& step, const Outside& outside, const Ranks& ranks, Run run)
{
    if (step.prescribed.motion == nullptr) { without_motions(step, outside, ranks, run); }
    else { run(make_move(step, Damped{step.motion.damping}, outside, ranks, Motions{step.prescribed})); }
}

/// Calls run with the Move for the motion. Kernels for each combination would take long to compile: bodies of several
/// ranks and prescribed motions always sum the external wrenches. One rank may have sand on a body and another none,
/// and both must integrate it by the same code.
template<class Exec, class Run>
void with_move(const BodyStep<Exec>& step, Run run)
{
    const SumOutside outside{step.motion.outside};
    if (step.bodies.role != nullptr) { with_motions(step, outside, Together{step.shared}, run); }
    else if (step.motion.outside.run != nullptr || step.prescribed.motion != nullptr)
    {
        with_motions(step, outside, Alone{}, run);
    }
    else { without_motions(step, NothingOutside{}, Alone{}, run); }
}

} // namespace tread::dem::moving
