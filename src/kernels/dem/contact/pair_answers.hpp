#pragma once

#include "backend/array.hpp"
#include "kernels/dem/contact/body_contact_kern.hpp"

namespace tread::dem
{

/// Responses of the pairs in the last substep: those on the first body in the order of the list, those on the second
/// body in the order of second bodies. Each body then sums contiguous entries, adjacent to those of its neighbours.
struct AnswersView
{
    Vec3<double>* force;       ///< N, on the first body
    Vec3<double>* torque;      ///< N m, on the first body about its centre of mass
    double*       stiffness;   ///< N/m, K; 0 = no contact
    double*       energy;      ///< J, elastic, including the springs of the patch
    double*       friction;    ///< J, dissipated in the substep
    double*       restitution; ///< J, dissipated in the substep

    const std::int32_t* place; ///< index of the pair in the order of second bodies
    Vec3<double>*       second_force;
    Vec3<double>*       second_torque;
    double*             second_stiffness;

    /// Stores the response of pair p; `second` = place[p].
    TREAD_HD void store(std::int64_t p, std::int32_t second, const PairResponse& response) const
    {
        force[p]                 = response.force;
        torque[p]                = response.torque_a;
        stiffness[p]             = response.stiffness;
        energy[p]                = response.energy;
        friction[p]              = response.friction;
        restitution[p]           = response.restitution;
        second_force[second]     = -response.force;
        second_torque[second]    = response.torque_b;
        second_stiffness[second] = response.stiffness;
    }
};

/// Memory of AnswersView.
template<class Exec>
struct Answers
{
    explicit Answers(const Exec& exec)
        : force(exec, "pair forces")
        , torque(exec, "pair torques")
        , stiffness(exec, "pair stiffnesses")
        , energy(exec, "pair energies")
        , friction(exec, "pair friction losses")
        , restitution(exec, "pair restitution losses")
        , place(exec, "pair places by second body")
        , second_force(exec, "pair forces by second body")
        , second_torque(exec, "pair torques by second body")
        , second_stiffness(exec, "pair stiffnesses by second body")
    {
    }

    void resize(std::int64_t pairs)
    {
        const auto all = [&](auto&... arrays) { (arrays.resize(pairs), ...); };
        all(force, torque, stiffness, energy, friction, restitution, place, second_force, second_torque,
            second_stiffness);
    }

    AnswersView view()
    {
        return {force.data(),       torque.data(), stiffness.data(),    energy.data(),        friction.data(),
                restitution.data(), place.data(),  second_force.data(), second_torque.data(), second_stiffness.data()};
    }

    Array<Exec, Vec3<double>> force;
    Array<Exec, Vec3<double>> torque;
    Array<Exec, double>       stiffness;
    Array<Exec, double>       energy;
    Array<Exec, double>       friction;
    Array<Exec, double>       restitution;
    Array<Exec, std::int32_t> place;
    Array<Exec, Vec3<double>> second_force;
    Array<Exec, Vec3<double>> second_torque;
    Array<Exec, double>       second_stiffness;
};

} // namespace tread::dem
