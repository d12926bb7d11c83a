#pragma once

#include "kernels/dem/bodies.hpp"

namespace tread::dem
{

/// What contacts gave a body since it was cleared (move.hpp books it).
struct ContactImpulse
{
    Vec3<double> linear;  ///< N s
    Vec3<double> angular; ///< N m s, about the centre of mass
};

/// Of one body, for sums and largest values over bodies.
struct BodyActivity
{
    double speed;        ///< m/s, largest of any of its points: |v| + |omega| times the bounding radius
    double net_force;    ///< N, |contact force + weight| of a body that is free to move, else 0
    double weight_power; ///< W, of the weight on the body
};

/// Gravity in m/s2; `bounding_radii` in m, by body.
void measure_activity(const Cpu&, const BodiesView& bodies, const double* bounding_radii, const Vec3<double>& gravity,
                      BodyActivity* activity);
void measure_activity(const Gpu&, const BodiesView& bodies, const double* bounding_radii, const Vec3<double>& gravity,
                      BodyActivity* activity);

} // namespace tread::dem
