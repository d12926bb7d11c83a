#pragma once

#include <cstdint>

#include "backend/array.hpp"
#include "backend/vector.hpp"

// State of the rigid bodies (rocks and wheels), fp64. Vectors in the world frame unless a line says body frame.
// Body frame: centre of mass at the origin, axes of the template's mesh.
namespace tread::dem
{

/// World degrees of freedom that a body does not have (bits of BodiesView::locked).
enum LockedFreedom : std::uint32_t
{
    lock_x     = 1,
    lock_y     = 2,
    lock_z     = 4,
    lock_roll  = 8,  ///< rotation about x
    lock_pitch = 16, ///< about y
    lock_yaw   = 32, ///< about z
    lock_all   = 63,

    hangs = 64, ///< no freedom is locked by it: BodiesView::weight says how much of the body's weight acts
};

/// What a rank has to do with a body, where several compute a scene. All of them number bodies alike and have memory
/// for all: what names a body, in contacts and in what they remember, means the same everywhere.
enum BodyRole : std::int32_t
{
    role_owner, ///< moves it and keeps its books
    role_guest, ///< moves it as its owner does, for its contacts with what this rank owns
    role_none,  ///< does not know where it is
};

/// How the time integration treats a locked degree of freedom: it keeps the velocity found in `velocity` and
/// `angular_velocity` (zero for a held body, the prescribed value for a driven one) whatever the forces.
struct BodiesView
{
    std::int64_t   count;
    Vec3<double>*  position;         ///< m
    Quat*          orientation;      ///< body to world
    Vec3<double>*  velocity;         ///< m/s
    Vec3<double>*  angular_velocity; ///< rad/s
    double*        mass;             ///< kg
    Sym3<double>*  inertia;          ///< kg m2, body frame
    double*        scale;            ///< of the template
    std::int32_t*  shape;            ///< index of the template
    std::int32_t*  material;         ///< index of the material
    std::uint32_t* locked;           ///< bits of LockedFreedom
    std::int32_t*  damped;           ///< 1 = takes part in the local damping of a settling phase
    Vec3<double>*  force;            ///< N, contact, of the last substep (gravity not included)
    Vec3<double>*  torque;           ///< N m, about the centre of mass
    double*        stiffness;        ///< N/m, sum over live contacts of K, of the last substep

    const std::int32_t* role = nullptr; ///< BodyRole; null: this rank owns all

    const double* weight = nullptr; ///< share of the weight that acts on a named body with `hangs`

    TREAD_HD bool is_owned(std::int64_t b) const { return role == nullptr || role[b] == role_owner; }
    TREAD_HD bool is_here(std::int64_t b) const { return role == nullptr || role[b] != role_none; }

    /// Share of a body's weight that acts. Only bodies with `hangs` read memory for it.
    TREAD_HD double acting_weight(std::int64_t b, std::uint32_t flags) const
    {
        return (flags & hangs) != 0 ? weight[b] : 1.0;
    }
};

/// Owner of what BodiesView shows.
template<class Exec>
struct Bodies
{
    explicit Bodies(const Exec& exec)
        : position(exec, "body position")
        , orientation(exec, "body orientation")
        , velocity(exec, "body velocity")
        , angular_velocity(exec, "body angular velocity")
        , mass(exec, "body mass")
        , inertia(exec, "body inertia")
        , scale(exec, "body scale")
        , shape(exec, "body shape")
        , material(exec, "body material")
        , locked(exec, "body locked freedoms")
        , damped(exec, "body damped")
        , force(exec, "body force")
        , torque(exec, "body torque")
        , stiffness(exec, "body stiffness")
        , role(exec, "body roles")
        , weight(exec, "shares of weight")
    {
    }

    BodiesView view()
    {
        return {position.size(), position.data(), orientation.data(), velocity.data(), angular_velocity.data(),
                mass.data(),     inertia.data(),  scale.data(),       shape.data(),    material.data(),
                locked.data(),   damped.data(),   force.data(),       torque.data(),   stiffness.data(),
                role.data(),     weight.data()};
    }

    /// Calls f(name, array) for every array but the roles, which are a rank's own affair.
    template<class F>
    void for_each_field(F f)
    {
        f("position", position);
        f("orientation", orientation);
        f("velocity", velocity);
        f("angular_velocity", angular_velocity);
        f("mass", mass);
        f("inertia", inertia);
        f("scale", scale);
        f("shape", shape);
        f("material", material);
        f("locked", locked);
        f("damped", damped);
        f("force", force);
        f("torque", torque);
        f("stiffness", stiffness);
        f("weight", weight);
    }

    Array<Exec, Vec3<double>>  position;
    Array<Exec, Quat>          orientation;
    Array<Exec, Vec3<double>>  velocity;
    Array<Exec, Vec3<double>>  angular_velocity;
    Array<Exec, double>        mass;
    Array<Exec, Sym3<double>>  inertia;
    Array<Exec, double>        scale;
    Array<Exec, std::int32_t>  shape;
    Array<Exec, std::int32_t>  material;
    Array<Exec, std::uint32_t> locked;
    Array<Exec, std::int32_t>  damped;
    Array<Exec, Vec3<double>>  force;
    Array<Exec, Vec3<double>>  torque;
    Array<Exec, double>        stiffness;
    Array<Exec, std::int32_t>  role;   ///< empty on one rank
    Array<Exec, double>        weight; ///< of the named bodies
};

} // namespace tread::dem
