#pragma once

#include <cstdint>

#include "backend/vector.hpp"

namespace tread::dem
{

/// Contact wrench on one body, world frame.
struct ContactWrench
{
    Vec3<double> force;     ///< N
    Vec3<double> torque;    ///< N m, about the centre of mass
    double       stiffness; ///< N/m, sum over its contacts

    TREAD_HD static ContactWrench zero() { return {Vec3<double>::Zero(), Vec3<double>::Zero(), 0.0}; }
};

TREAD_HD ContactWrench operator+(const ContactWrench& a, const ContactWrench& b)
{
    return {a.force + b.force, a.torque + b.torque, a.stiffness + b.stiffness};
}

/// External wrenches on bodies (not from other bodies or walls), in parts that the integration sums for each body.
struct OutsideWrenches
{
    const std::int32_t*  run   = nullptr; ///< [bodies], run of the body's parts; -1 = none; null: none for any body
    const std::int32_t*  first = nullptr; ///< [runs + 1], first part of each run
    const ContactWrench* part  = nullptr;
};

} // namespace tread::dem
