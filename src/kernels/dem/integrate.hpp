#pragma once

#include "kernels/dem/bodies.hpp"
#include "kernels/dem/totals.hpp"

namespace tread::dem
{

/// Zeroes force, torque and stiffness of all bodies: what the contacts of a substep then add to.
void clear_wrenches(const Cpu&, const BodiesView& bodies);
void clear_wrenches(const Gpu&, const BodiesView& bodies);

/// Moves all bodies by dt (s) under their contact wrenches and gravity (m/s2); adds to `totals`, a row a body.
void integrate(const Cpu&, const BodiesView& bodies, BodyTotal* totals, const Vec3<double>& gravity, double dt);
void integrate(const Gpu&, const BodiesView& bodies, BodyTotal* totals, const Vec3<double>& gravity, double dt);

/// The same with local damping alpha, in [0, 1], of the bodies that take part in it.
void integrate_damped(const Cpu&, const BodiesView& bodies, BodyTotal* totals, const Vec3<double>& gravity,
                      double alpha, double dt);
void integrate_damped(const Gpu&, const BodiesView& bodies, BodyTotal* totals, const Vec3<double>& gravity,
                      double alpha, double dt);

} // namespace tread::dem
