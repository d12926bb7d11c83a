#pragma once

#include "backend/vector.hpp"
#include "io/summary.hpp"
#include "solver/ledger/sand_report.hpp"

namespace tread::solver
{

class StateFile;

/// Sums over the bodies for one step, and the largest overlap and speed. Holds doubles only.
struct RigidReport
{
    double       net_force       = 0;                    ///< N, sum over free bodies of |contact + weight|
    double       friction        = 0;                    ///< J, body-body friction in the step
    double       restitution     = 0;                    ///< J, body-body normal damping in the step
    double       damped          = 0;                    ///< J, dissipated by local damping in the step
    double       driver_work     = 0;                    ///< J, work of what holds and drives bodies, in the step
    double       scaling_work    = 0;                    ///< J, taken by the scaled inertia of rocks, in the step
    double       sand_work       = 0;                    ///< J, work of sand on bodies, in the step
    double       weight_power    = 0;                    ///< W, power of the weight at the velocity after the step
    Vec3<double> wall_impulse    = Vec3<double>::Zero(); ///< N s, in the step
    Vec3<double> damping_impulse = Vec3<double>::Zero();
    Vec3<double> driver_impulse  = Vec3<double>::Zero();
    double       overlap         = 0; ///< largest overlap over the smaller radius of the pair
    double       largest_speed   = 0; ///< m/s
    double       substep         = 0; ///< s, the same on all ranks
};

/// Number of leading doubles that are summed, and of those after them whose maximum is taken.
inline constexpr int rigid_report_sums = 17, rigid_report_peaks = 3;
static_assert(sizeof(RigidReport) == (rigid_report_sums + rigid_report_peaks) * sizeof(double));

/// Energy of the contacts of sand with bodies in one step.
struct ContactReport
{
    double friction = 0; ///< J, dissipated in the step
    double energy   = 0; ///< J, elastic, stored at the end of the step
};

/// Mass, energy and momentum of the bodies.
struct RigidCensus
{
    double       mass     = 0;                    ///< kg
    double       kinetic  = 0;                    ///< J, translation and rotation
    double       contact  = 0;                    ///< J, elastic, body-body and body-wall
    double       gravity  = 0;                    ///< J, -m g . x
    Vec3<double> momentum = Vec3<double>::Zero(); ///< kg m/s
};

/// Everything that the balances at one time need.
struct Census
{
    SandCensus  sand;
    RigidCensus rigid;
    double      sand_contact = 0; ///< J, elastic, sand-body
};

/// Energy by kind, J: present stores, and losses and work since the start.
struct EnergyRow
{
    double kinetic_points = 0, strain = 0, kinetic_bodies = 0, contact = 0, gravity = 0;
    /// Velocities of points are half a step older than their positions (symplectic Euler is leapfrog): half a step of
    /// the power of stress and weight brings the sum of stores from first to second order in dt.
    double half_step = 0;
    double plastic = 0, friction = 0, restitution = 0, damping = 0, transfer = 0, work_in = 0;
    /// Work of contact forces on sand and bodies that is neither friction nor stored in the contacts' springs:
    /// substeps use other velocities than the grid's mean over the step. First order in dt.
    double coupling     = 0;
    double mass_scaling = 0; ///< taken by the scaled inertia of rocks, less what it has given back
    double total        = 0; ///< stores and losses minus work_in: constant if nothing is unaccounted
};

struct BalanceRow
{
    double       mass          = 0; ///< kg
    Vec3<double> momentum      = Vec3<double>::Zero();
    double       impulse_error = 0; ///< |momentum change minus impulses| over total weight x time
};

/// Accounts for mass, momentum and energy over a run.
class Ledger
{
public:
    Ledger(Vec3<double> gravity, const Census& start);

    /// Accounts for `steps` steps of dt (s) each.
    void steps(double dt, std::int64_t steps, const SandReport& sand, const RigidReport& rigid,
               const ContactReport& contact, double moving_mass);

    /// Gravity has turned to `gravity` (m/s2) between the two censuses, at one time. From now on potential energy
    /// counts from where everything is, so that it does not jump.
    void turn_gravity(const Vec3<double>& gravity, const Census& before, const Census& after);

    /// Contacts of bodies, and of sand with bodies, that stored these energies (J) have ceased: they count as friction.
    void release(double bodies, double sand);

    const Vec3<double>& gravity() const { return gravity_; }

    EnergyRow       energy(const Census& now);
    BalanceRow      balance(const Census& now);
    io::ErrorReport errors() const { return errors_; }

    /// Saves to a checkpoint, or loads into a ledger of the same scene.
    void transfer(StateFile& file);

private:
    void transfer_start(StateFile& file);
    void transfer_sums(StateFile& file);

    double gravity_energy(const Census& now) const;
    double stored(const Census& now) const;

    /// J, the half step of a run that has become unstable. Symplectic Euler keeps the sum of stores and half step
    /// constant even then: one grows as the other decreases.
    double gained(const Census& now) const;

    Vec3<double>    gravity_;
    double          largest_gravity_;   ///< m/s2, so far
    double          turned_        = 0; ///< J, what turns of gravity have added to -m g . x
    double          start_gravity_ = 0; ///< J
    Census          start_;
    double          start_energy_ = 0;
    double          time_         = 0;
    double          kinetic_points_;
    double          half_step_        = 0; ///< J
    double          stress_half_step_ = 0;
    double          plastic_ = 0, friction_ = 0, restitution_ = 0, damping_ = 0, transfer_ = 0, work_in_ = 0;
    double          coupling_ = 0, contact_energy_ = 0, mass_scaling_ = 0;
    double          body_half_step_ = 0; ///< J
    double          weight_power_   = 0; ///< W, on bodies
    Vec3<double>    impulse_        = Vec3<double>::Zero();
    io::ErrorReport errors_;
    double          largest_exchange_ = 0;
};

} // namespace tread::solver
