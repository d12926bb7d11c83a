#pragma once

#include "kernels/dem/bodies.hpp"

namespace tread::dem
{

/// Contact impulses on a body since they were cleared (accumulated by move.hpp).
struct ContactImpulse
{
    Vec3<double> linear;  ///< N s
    Vec3<double> angular; ///< N m s, about the centre of mass
};

/// Activity of one body, for sums and maxima over bodies.
struct BodyActivity
{
    double speed;        ///< m/s, maximum over the body's points: |v| + |omega| times the bounding radius
    double net_force;    ///< N, |contact force + weight| of a body that is free to move and has no prescribed motion
    double weight_power; ///< W, power of the weight on the body
};

/// Computes the activity of every body. Gravity in m/s2; `bounding_radii` in m, per body.
template<class Exec>
void measure_activity(const Exec& exec, const BodiesView& bodies, const double* bounding_radii,
                      const Vec3<double>& gravity, BodyActivity* activity);

} // namespace tread::dem
