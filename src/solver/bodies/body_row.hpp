#pragma once

#include "backend/vector.hpp"

namespace tread::solver
{

/// State of one named body at one time. Force and torque sum all contacts, averaged since the last row.
struct BodyRow
{
    Vec3<double> position;         ///< m
    Vec3<double> velocity;         ///< m/s
    Vec3<double> angular_velocity; ///< rad/s
    Vec3<double> force;            ///< N
    Vec3<double> torque;           ///< N m, about the centre of mass
    Vec3<double> axle;             ///< unit vector, world frame
    double       lowest;           ///< m, height of the lowest point
    double       surface = 0;      ///< m, height of the terrain under the body before bodies pressed on it (SurfaceMap)
    Vec3<double> reaction_force  = Vec3<double>::Zero(); ///< N, mean of what a prescribed motion exerts (Prescribed)
    Vec3<double> reaction_torque = Vec3<double>::Zero(); ///< N m, likewise, about the centre of mass
    Quat         orientation     = Quat::Identity();     ///< body to world
    double       power           = 0; ///< W, mean that the axle supplied since the last row (AxleTurn)
};

/// Angular velocity (rad/s) about the axle.
inline double spin_of(const BodyRow& row) { return row.angular_velocity.dot(row.axle); }

} // namespace tread::solver
