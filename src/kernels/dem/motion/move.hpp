#pragma once

#include "kernels/dem/joints/joint_rows.hpp"
#include "kernels/dem/motion/impulses.hpp"
#include "kernels/dem/motion/mass_scaling.hpp"
#include "kernels/dem/motion/outside.hpp"
#include "kernels/dem/motion/prescribed.hpp"
#include "kernels/dem/motion/shared.hpp"
#include "kernels/dem/motion/totals.hpp"
#include "kernels/dem/pairs/displacement_limit.hpp"
#include "kernels/dem/pairs/pairs.hpp"

namespace tread::dem
{

/// Contact impulses on the named bodies, which are the first bodies of a scene.
struct NamedImpulses
{
    ContactImpulse* impulse;
    std::int64_t    count;
};

/// Parameters of the motion of bodies other than contact forces.
struct Motion
{
    Vec3<double> gravity; ///< m/s2
    double       damping; ///< local damping coefficient in [0, 1]; 0 = none
    double       dt;      ///< s, of the substep

    OutsideWrenches outside = {};

    InertiaScaling scaling = {};
};

/// All data that a substep of bodies needs.
template<class Exec>
struct BodyStep
{
    Pairs<Exec>&  pairs; ///< has no list if no body may meet another body or a wall
    BodiesView    bodies;
    BodyLaw       law;
    BodyTotal*    totals;
    NamedImpulses named;
    Motion        motion;
    SharedView    shared = {};

    PrescribedView prescribed = {}; ///< empty in a scene without motions
    JointsView     joints     = {}; ///< empty in a scene without joints

    DisplacementLimit limit = {}; ///< empty where the list of pairs lasts for all substeps
};

/// First part of move_bodies on several ranks: computes this rank's shares step.shared.wrench, which are then
/// exchanged.
template<class Exec>
void share_wrenches(const Exec&, const BodyStep<Exec>& step);

/// Second half of a substep, after evaluate_contacts. Sets every body's force, torque and stiffness to the sum of the
/// external wrenches and of its pairs' responses (if pairs were ever found); adds wall impulses, losses and the
/// impulses of named bodies to the energy and momentum balance; solves the joints; moves all bodies that are awake; and
/// looks ahead where step.limit asks for it. Every sum has a fixed order on one backend. Allocates nothing.
template<class Exec>
void move_bodies(const Exec&, const BodyStep<Exec>& step);

} // namespace tread::dem
