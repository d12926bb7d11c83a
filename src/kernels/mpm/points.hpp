#pragma once

#include <cstdint>

#include "backend/array.hpp"
#include "backend/vector.hpp"

// State of the material points, structure of arrays. Positions are fp64 (1e-13 m at 1 km); fields are Real.
namespace tread::mpm
{

template<class Real>
struct PointsView
{
    std::int64_t      count;
    Planes<double, 3> position;      ///< m
    Planes<Real, 3>   velocity;      ///< m/s
    Planes<Real, 9>   affine;        ///< 1/s, APIC only (row-major); else null
    Planes<Real, 6>   stress;        ///< Pa, Cauchy, tension positive
    Planes<double, 3> start;         ///< m, position that displacement is measured from
    Real*             mass;          ///< kg
    Real*             volume;        ///< m3, initial
    Real*             volume_ratio;  ///< current over initial volume
    Real*             plastic_shear; ///< equivalent plastic shear strain
    Real*             plastic_rate;  ///< 1/s, its rate in the last step
    Real*             volume_gap;    ///< log volume opened at the apex that must close before compression
    std::uint32_t*    id;            ///< unique, for ever
    std::uint8_t*     material;

    // Coupling with bodies only; else null.
    Planes<Real, 3> contact_force;   ///< N, impulse of the step's contacts over dt
    Planes<Real, 3> grid_velocity;   ///< m/s, interpolated at the end of the last step
    Planes<Real, 3> support;         ///< m/s2, grid acceleration of the last step without its contact force
};

} // namespace tread::mpm
