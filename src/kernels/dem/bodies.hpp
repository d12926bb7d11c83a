#pragma once

#include <cstdint>

#include "backend/array.hpp"
#include "backend/vector.hpp"

// State of the rigid bodies (rocks and wheels), fp64. Vectors are in the world frame unless marked as body frame.
// Body frame: origin at the centre of mass, axes of the template's mesh.
namespace tread::dem
{

/// World-frame degrees of freedom that are locked (bits of BodiesView::locked).
enum LockedFreedom : std::uint32_t
{
    lock_x     = 1,
    lock_y     = 2,
    lock_z     = 4,
    lock_roll  = 8,  ///< rotation about x
    lock_pitch = 16, ///< rotation about y
    lock_yaw   = 32, ///< rotation about z
    lock_all   = 63,

    hangs = 64, ///< locks nothing: the share BodiesView::weight of the body's weight acts

    prescribed = 128, ///< locks nothing by itself: the body moves by its row of PrescribedView
    unyielding = 256, ///< locks nothing by itself: a prescribed motion holds all degrees of freedom

    all_flags = 511,
};

/// Role of a rank for a body that it has a row for. In a parallel run a rank has rows for the named bodies, and for the
/// rocks that it owns or holds as ghosts. A body's number is its place in the scene, the same on all ranks; rows ascend
/// with numbers, so that the first body of a pair is the same on every rank.
enum BodyRole : std::int32_t
{
    role_owner, ///< integrates the body and accounts for its energy
    role_ghost, ///< integrates the body as its owner does, for contacts with what this rank owns
    role_none,  ///< has no position of the body
};

/// View of the bodies. Time integration leaves the velocity of a locked degree of freedom as stored in `velocity` and
/// `angular_velocity` (zero for a held body, prescribed for a driven one), whatever the forces.
struct BodiesView
{
    std::int64_t   count;
    Vec3<double>*  position;         ///< m
    Quat*          orientation;      ///< body to world
    Vec3<double>*  velocity;         ///< m/s
    Vec3<double>*  angular_velocity; ///< rad/s
    double*        mass;             ///< kg
    Sym3<double>*  inertia;          ///< kg m2, body frame
    double*        scale;            ///< scale factor of the template
    std::int32_t*  shape;            ///< index of the template
    std::int32_t*  material;         ///< index of the material
    std::uint32_t* locked;           ///< bits of LockedFreedom
    std::int32_t*  damped;           ///< 1 = takes part in the local damping of a settling phase
    Vec3<double>*  force;            ///< N, contact force of the last substep (without gravity)
    Vec3<double>*  torque;           ///< N m, about the centre of mass
    double*        stiffness;        ///< N/m, sum of K over the touching contacts of the last substep

    const std::int32_t* role   = nullptr; ///< BodyRole; null: this rank owns all bodies
    const std::int32_t* number = nullptr; ///< of each body in the scene; null: that of its row

    const double* weight = nullptr; ///< share of the weight that acts on each named body with `hangs`

    std::int32_t* asleep = nullptr; ///< 1 = held at rest (sleep/sleep.hpp); null: no body may sleep

    TREAD_HD bool is_owned(std::int64_t b) const { return role == nullptr || role[b] == role_owner; }
    TREAD_HD bool is_here(std::int64_t b) const { return role == nullptr || role[b] != role_none; }

    TREAD_HD bool is_asleep(std::int64_t b) const { return asleep != nullptr && asleep[b] != 0; }

    /// Whether no force moves the body, as if its mass were infinite.
    TREAD_HD bool is_fixed(std::int64_t b) const
    {
        return (locked[b] & lock_all) == lock_all || (locked[b] & unyielding) != 0;
    }

    /// Returns the share of a body's weight that acts. Reads memory only for bodies with `hangs`.
    TREAD_HD double acting_weight(std::int64_t b, std::uint32_t flags) const
    {
        return (flags & hangs) != 0 ? weight[b] : 1.0;
    }
};

/// Memory of BodiesView.
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
        , number(exec, "body numbers")
        , weight(exec, "shares of weight")
        , asleep(exec, "sleeping bodies")
    {
    }

    BodiesView view()
    {
        return {position.size(), position.data(), orientation.data(), velocity.data(), angular_velocity.data(),
                mass.data(),     inertia.data(),  scale.data(),       shape.data(),    material.data(),
                locked.data(),   damped.data(),   force.data(),       torque.data(),   stiffness.data(),
                role.data(),     number.data(),   weight.data(),      asleep.data()};
    }

    /// Calls f(name, array) for every array except roles and numbers, which differ between ranks, and `asleep`, which
    /// belongs to the sleep of bodies.
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
    Array<Exec, std::int32_t>  role;   ///< empty in a run with one rank
    Array<Exec, std::int32_t>  number; ///< likewise
    Array<Exec, double>        weight; ///< of the named bodies
    Array<Exec, std::int32_t>  asleep; ///< empty where no body may sleep
};

} // namespace tread::dem
