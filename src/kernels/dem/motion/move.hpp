#pragma once

#include "kernels/dem/motion/impulses.hpp"
#include "kernels/dem/motion/outside.hpp"
#include "kernels/dem/motion/shared.hpp"
#include "kernels/dem/motion/totals.hpp"
#include "kernels/dem/pairs/pairs.hpp"

namespace tread::dem
{

/// The first bodies of a scene, which it names, and what contacts gave them.
struct NamedImpulses
{
    ContactImpulse* impulse;
    std::int64_t    count;
};

/// What moves bodies beside their contacts.
struct Motion
{
    Vec3<double> gravity; ///< m/s2
    double       damping; ///< local, in [0, 1]; 0 = none
    double       dt;      ///< s, of the substep

    OutsideWrenches outside = {};
};

/// All that a substep of bodies needs.
template<class Exec>
struct BodyStep
{
    Pairs<Exec>&  pairs; ///< without a list where no body may meet another or a wall
    BodiesView    bodies;
    BodyLaw       law;
    BodyTotal*    totals;
    NamedImpulses named;
    Motion        motion;
    SharedView    shared = {};
};

/// First half of what follows, on several ranks: this rank's shares of step.shared.wrench, which the others are to
/// have.
void share_wrenches(const Cpu&, const BodyStep<Cpu>& step);
void share_wrenches(const Gpu&, const BodyStep<Gpu>& step);

/// Second half of a substep, after evaluate_contacts: every body's force, torque and stiffness become the sum of what
/// acts on it from outside and what its pairs answer, if pairs were ever found; books wall impulses, losses and the
/// impulses of named bodies, and moves all bodies. Every sum has a fixed order on one backend. Allocates nothing.
void move_bodies(const Cpu&, const BodyStep<Cpu>& step);
void move_bodies(const Gpu&, const BodyStep<Gpu>& step);

} // namespace tread::dem
