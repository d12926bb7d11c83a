#pragma once

#include <cstdint>

#include "backend/vector.hpp"

namespace tread::dem
{

/// What contacts do to one body, world frame.
struct ContactWrench
{
    Vec3<double> force;     ///< N
    Vec3<double> torque;    ///< N m, about the centre of mass
    double       stiffness; ///< N/m, sum over the contacts

    TREAD_HD static ContactWrench zero() { return {Vec3<double>::Zero(), Vec3<double>::Zero(), 0.0}; }
};

TREAD_HD ContactWrench operator+(const ContactWrench& a, const ContactWrench& b)
{
    return {a.force + b.force, a.torque + b.torque, a.stiffness + b.stiffness};
}

/// What acts on bodies beside other bodies and walls, in parts: whoever moves a body adds up its own.
struct OutsideWrenches
{
    const std::int32_t*  run   = nullptr; ///< [bodies], of the body's parts; -1 = none; null: nothing acts on any
    const std::int32_t*  first = nullptr; ///< [runs + 1], the parts of each run
    const ContactWrench* part  = nullptr;
};

} // namespace tread::dem
