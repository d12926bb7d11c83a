#pragma once

#include "backend/array.hpp"
#include "kernels/dem/contact/body_contact_kern.hpp"

namespace tread::dem
{

/// What the pairs did to their bodies in the last substep: to the first body in the order of the list, to the second in
/// that of second bodies. A body then finds what it is to add up side by side, and its neighbours theirs next to it.
struct AnswersView
{
    Vec3<double>* force;       ///< N, on the first
    Vec3<double>* torque;      ///< N m, about its centre
    double*       stiffness;   ///< N/m, K; 0 = apart
    double*       energy;      ///< J, elastic, springs of the patch included
    double*       friction;    ///< J, lost in the substep
    double*       restitution; ///< J, lost in the substep

    const std::int32_t* place; ///< of the pair in the order of second bodies
    Vec3<double>*       second_force;
    Vec3<double>*       second_torque;
    double*             second_stiffness;

    /// `second` = place[p].
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

/// Owner of what AnswersView shows.
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
