#pragma once

#include "kernels/dem/impulses.hpp"
#include "kernels/dem/pairs.hpp"
#include "kernels/dem/totals.hpp"

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
};

/// Second half of a substep, after evaluate_contacts: adds what the pairs answer to every body's force, torque and
/// stiffness (in a scene whose bodies touch sand, to what sand put there), books wall impulses, losses and the impulses
/// of named bodies, and moves all bodies. Every sum has a fixed order on one backend. Allocates nothing.
void move_bodies(const Cpu&, Pairs<Cpu>& pairs, const BodiesView& bodies, BodyTotal* totals, const NamedImpulses& named,
                 const Motion& motion);
void move_bodies(const Gpu&, Pairs<Gpu>& pairs, const BodiesView& bodies, BodyTotal* totals, const NamedImpulses& named,
                 const Motion& motion);

} // namespace tread::dem
