#pragma once

#include <algorithm>
#include <cstdint>
#include <type_traits>

#include "backend/array.hpp"
#include "backend/vector.hpp"

// State of the material points, structure of arrays. Positions are fp64 (1e-13 m at 1 km); other fields are Real.
namespace tread::mpm
{

template<class Real>
struct PointsView
{
    std::int64_t      count;
    Planes<double, 3> position;     ///< m
    Planes<double, 3> start;        ///< m, reference position of the displacement
    Planes<Real, 3>   velocity;     ///< m/s
    Planes<Real, 6>   stress;       ///< Pa, Kirchhoff: Cauchy times volume_ratio; tension positive
    Real*             mass;         ///< kg
    Real*             volume;       ///< m3, initial
    Real*             volume_ratio; ///< current over initial volume
    std::uint32_t*    id;           ///< unique during the whole run
    std::uint8_t*     material;

    Planes<Real, 9> affine; ///< 1/s, row-major affine velocity field; APIC and AFLIP only, else null

    // Plastic materials only, otherwise null.
    Real* plastic_shear; ///< equivalent plastic shear strain
    Real* plastic_rate;  ///< 1/s, rate of plastic_shear in the last step
    Real* volume_gap;    ///< log volume opened at the apex that must close before compression

    Real* cap_pressure; ///< Pa, pressure at which the cap flows; capped materials only, otherwise null
    Real* mean_strain;  ///< nonlocal mean of the skeleton's log volume ratio; nonlocal materials only, otherwise null

    // Coupling with bodies only, otherwise null.
    Planes<Real, 3> contact_force; ///< N, contact impulse of the step divided by dt
    Planes<Real, 3> grid_velocity; ///< m/s, interpolated at the end of the last step
    Planes<Real, 3> support;       ///< m/s2, grid acceleration of the last step without its contact force
};

/// Optional fields of the point state that a scene needs.
struct PointFields
{
    bool affine;
    bool plastic;
    bool coupled;
    bool capped   = false; ///< some material has a cap
    bool nonlocal = false; ///< some material softens by a mean over its surroundings
};

/// Memory of PointsView. Fields that the scene does not need are not allocated.
template<class Exec, class Real>
struct Points
{
    explicit Points(const Exec& exec)
        : position(exec, "point position")
        , start(exec, "point start")
        , velocity(exec, "point velocity")
        , stress(exec, "point stress")
        , mass(exec, "point mass")
        , volume(exec, "point volume")
        , volume_ratio(exec, "point volume ratio")
        , id(exec, "point id")
        , material(exec, "point material")
        , affine(exec, "point affine velocity")
        , plastic_shear(exec, "point plastic shear")
        , plastic_rate(exec, "point plastic rate")
        , volume_gap(exec, "point volume gap")
        , cap_pressure(exec, "point cap pressure")
        , mean_strain(exec, "point mean strain")
        , contact_force(exec, "point contact force")
        , grid_velocity(exec, "point grid velocity")
        , support(exec, "point support")
    {
    }

    /// Allocates memory for `points`; values are zero. The scene's fields are allocated even without points.
    void allocate(std::int64_t points, PointFields fields)
    {
        count           = points;
        stride          = std::max<std::int64_t>(points, 1);
        const auto take = [&](auto& array, int components, bool wanted)
        {
            array.resize(wanted ? components * stride : 0);
            array.fill_zero();
        };
        take(position, 3, true);
        take(start, 3, true);
        take(velocity, 3, true);
        take(stress, 6, true);
        take(mass, 1, true);
        take(volume, 1, true);
        take(volume_ratio, 1, true);
        take(id, 1, true);
        take(material, 1, true);
        take(affine, 9, fields.affine);
        take(plastic_shear, 1, fields.plastic);
        take(plastic_rate, 1, fields.plastic);
        take(volume_gap, 1, fields.plastic);
        take(cap_pressure, 1, fields.capped);
        take(mean_strain, 1, fields.nonlocal);
        take(contact_force, 3, fields.coupled);
        take(grid_velocity, 3, fields.coupled);
        take(support, 3, fields.coupled);
    }

    /// Ensures capacity for at least `points`; present points keep their values.
    void reserve(std::int64_t points)
    {
        if (points <= stride) { return; }
        const std::int64_t wider = points + points / 8;
        for_each_field(
            [&](auto& array, int components)
            {
                std::remove_reference_t<decltype(array)> larger(array.exec(), array.name(), components * wider);
                const auto bytes = static_cast<std::size_t>(count) * sizeof(*array.data());
                for (int c = 0; c < components; ++c)
                {
                    copy(array.exec(), larger.data() + c * wider, array.data() + c * stride, bytes);
                }
                array.swap(larger);
            });
        stride = wider;
    }

    PointsView<Real> view()
    {
        return {count,
                {position.data(), stride},
                {start.data(), stride},
                {velocity.data(), stride},
                {stress.data(), stride},
                mass.data(),
                volume.data(),
                volume_ratio.data(),
                id.data(),
                material.data(),
                {affine.data(), stride},
                plastic_shear.data(),
                plastic_rate.data(),
                volume_gap.data(),
                cap_pressure.data(),
                mean_strain.data(),
                {contact_force.data(), stride},
                {grid_velocity.data(), stride},
                {support.data(), stride}};
    }

    /// Calls f(array, components) for every allocated field.
    template<class F>
    void for_each_field(F f)
    {
        for_each_named_field([&](const char*, auto& array, int components) { f(array, components); });
    }

    /// Calls f(name, array, components) for every allocated field.
    template<class F>
    void for_each_named_field(F f)
    {
        const auto visit = [&](const char* name, auto& array, int components)
        {
            if (array.size() > 0) { f(name, array, components); }
        };
        visit("position", position, 3);
        visit("start", start, 3);
        visit("velocity", velocity, 3);
        visit("stress", stress, 6);
        visit("mass", mass, 1);
        visit("volume", volume, 1);
        visit("volume_ratio", volume_ratio, 1);
        visit("id", id, 1);
        visit("material", material, 1);
        visit("affine", affine, 9);
        visit("plastic_shear", plastic_shear, 1);
        visit("plastic_rate", plastic_rate, 1);
        visit("volume_gap", volume_gap, 1);
        visit("cap_pressure", cap_pressure, 1);
        visit("mean_strain", mean_strain, 1);
        visit("contact_force", contact_force, 3);
        visit("grid_velocity", grid_velocity, 3);
        visit("support", support, 3);
    }

    std::int64_t count  = 0; ///< number of points
    std::int64_t stride = 0; ///< stride of the planes: capacity in points

    Array<Exec, double>        position;
    Array<Exec, double>        start;
    Array<Exec, Real>          velocity;
    Array<Exec, Real>          stress;
    Array<Exec, Real>          mass;
    Array<Exec, Real>          volume;
    Array<Exec, Real>          volume_ratio;
    Array<Exec, std::uint32_t> id;
    Array<Exec, std::uint8_t>  material;
    Array<Exec, Real>          affine;
    Array<Exec, Real>          plastic_shear;
    Array<Exec, Real>          plastic_rate;
    Array<Exec, Real>          volume_gap;
    Array<Exec, Real>          cap_pressure;
    Array<Exec, Real>          mean_strain;
    Array<Exec, Real>          contact_force;
    Array<Exec, Real>          grid_velocity;
    Array<Exec, Real>          support;
};

} // namespace tread::mpm
