#pragma once

#include "kernels/dem/bodies.hpp"

namespace tread::dem
{

/// Body data that contacts read, in one record: the second body of a pair is anywhere in memory, and a record costs one
/// cache line.
struct alignas(16) ContactBody
{
    Vec3<double> position; ///< m
    double       scale;
    Quat         orientation;
    Vec3<double> velocity;     ///< m/s
    double       inverse_mass; ///< 1/kg; 0 if every degree of freedom is locked (infinite mass, like a wall)
    Vec3<double> spin;         ///< rad/s
    std::int32_t shape;
    std::int32_t material;
};
static_assert(sizeof(ContactBody) == 128);

TREAD_HD ContactBody contact_body(const BodiesView& bodies, std::int64_t b)
{
    return {bodies.position[b],
            bodies.scale[b],
            bodies.orientation[b],
            bodies.velocity[b],
            bodies.is_fixed(b) ? 0.0 : 1.0 / bodies.mass[b],
            bodies.angular_velocity[b],
            bodies.shape[b],
            bodies.material[b]};
}

/// Loads a record by eight 16-byte loads instead of some thirty.
TREAD_HD ContactBody load(const ContactBody* from)
{
#if defined(__CUDA_ARCH__)
    const auto*   words = reinterpret_cast<const double2*>(from);
    const double2 place = words[0], scale = words[1], turn = words[2], turn_end = words[3], velocity = words[4],
                  mass = words[5], spin = words[6], kind = words[7];
    return {Vec3<double>(place.x, place.y, scale.x),
            scale.y,
            Quat(turn_end.y, turn.x, turn.y, turn_end.x),
            Vec3<double>(velocity.x, velocity.y, mass.x),
            mass.y,
            Vec3<double>(spin.x, spin.y, kind.x),
            __double2loint(kind.y),
            __double2hiint(kind.y)};
#else
    return *from;
#endif
}

TREAD_HD void store(ContactBody* to, const ContactBody& body)
{
#if defined(__CUDA_ARCH__)
    auto*       words = reinterpret_cast<double2*>(to);
    const auto& turn  = body.orientation.coeffs();
    words[0]          = {body.position[0], body.position[1]};
    words[1]          = {body.position[2], body.scale};
    words[2]          = {turn[0], turn[1]};
    words[3]          = {turn[2], turn[3]};
    words[4]          = {body.velocity[0], body.velocity[1]};
    words[5]          = {body.velocity[2], body.inverse_mass};
    words[6]          = {body.spin[0], body.spin[1]};
    words[7]          = {body.spin[2], __hiloint2double(body.material, body.shape)};
#else
    *to = body;
#endif
}

} // namespace tread::dem
