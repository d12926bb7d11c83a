#include "world/materials.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "scene/contacts.hpp"
#include "scene/phase_settings.hpp"

namespace tread::world
{
namespace
{

/// Share of one side in 1/E* and 1/G* (Eqs. 8 and 10); a wall does not deform.
struct Compliance
{
    double normal;
    double shear;
};

Compliance compliance(const scene::Material& material)
{
    const double shear_modulus = material.young / (2 * (1 + material.poisson));
    return {(1 - material.poisson * material.poisson) / material.young, (2 - material.poisson) / shear_modulus};
}

mpm::Strength strength(const scene::Material& material)
{
    return {material.friction_angle_deg, material.dilation_angle_deg, material.cohesion};
}

mpm::DensityDependence density_dependence(const scene::Material& material)
{
    return {material.relative_density,
            material.void_ratio_min,
            material.void_ratio_max,
            material.bolton_q,
            1,
            material.bolton_fit == scene::BoltonFit::triaxial ? 3.0 : 5.0,
            material.softening_length ? material.nonlocal_weight : 0};
}

mpm::ConeFit cone_fit(scene::ConeFit fit)
{
    switch (fit)
    {
    case scene::ConeFit::compression:
        return mpm::ConeFit::compression;
    case scene::ConeFit::extension:
        return mpm::ConeFit::extension;
    case scene::ConeFit::plane_strain:
        return mpm::ConeFit::plane_strain;
    }
    return mpm::ConeFit::compression;
}

template<class Real>
mpm::MaterialParameters<Real> law_of(const scene::Material& material)
{
    const auto elasticity =
        mpm::make_elasticity<Real>(material.young, material.poisson, material.density, material.young_pressure);
    switch (material.model)
    {
    case scene::MaterialModel::mohr_coulomb:
        return mpm::make_material(elasticity, mpm::make_mohr_coulomb<Real>(strength(material)));
    case scene::MaterialModel::drucker_prager:
        return mpm::make_material(
            elasticity, mpm::make_drucker_prager<Real>(strength(material), cone_fit(material.drucker_prager_fit)));
    case scene::MaterialModel::drucker_prager_cap:
        return mpm::make_material(
            elasticity, mpm::make_drucker_prager_cap<Real>(strength(material), cone_fit(material.drucker_prager_fit),
                                                           material.cap_pressure, material.cap_index));
    case scene::MaterialModel::bolton:
        return mpm::make_material(elasticity, mpm::make_bolton<Real>(strength(material), density_dependence(material)));
    case scene::MaterialModel::elastic:
    case scene::MaterialModel::rigid:
        break;
    }
    return mpm::make_material(elasticity);
}

dem::PairProperties pair(const scene::Contact& contact, Compliance a, Compliance b)
{
    return {1 / (a.normal + b.normal),          1 / (a.shear + b.shear),  contact.friction,
            damping_ratio(contact.restitution), contact.rolling_friction, contact.touch};
}

} // namespace

contact::RadiusRule radius_rule(scene::PointRadius rule)
{
    return rule == scene::PointRadius::sphere ? contact::RadiusRule::sphere : contact::RadiusRule::semi_domain;
}

contact::PointMotion point_motion(scene::PointMotion motion)
{
    switch (motion)
    {
    case scene::PointMotion::supported:
        return contact::PointMotion::supported;
    case scene::PointMotion::ballistic:
        return contact::PointMotion::ballistic;
    case scene::PointMotion::frozen:
        return contact::PointMotion::frozen;
    }
    return contact::PointMotion::supported;
}

double hertz_factor(scene::HertzFactor factor)
{
    return factor == scene::HertzFactor::standard ? 1.0 : 1.0 / std::numbers::sqrt2;
}

double initial_friction_angle_deg(const scene::Material& material)
{
    if (material.model != scene::MaterialModel::bolton) { return material.friction_angle_deg; }
    const auto law = mpm::make_bolton<double>(strength(material), density_dependence(material));
    return material.friction_angle_deg +
           law.friction_per_index * mpm::dilatancy_index(law, 1.0, 0.0) * 180 / std::numbers::pi;
}

double active_stress(const scene::Material& material, double vertical)
{
    switch (material.model)
    {
    case scene::MaterialModel::drucker_prager:
    case scene::MaterialModel::drucker_prager_cap:
    {
        // sqrt(J2) = (v - h) / sqrt 3 intersects the cone k + eta (v + 2 h) / 3.
        const auto   cone = mpm::make_drucker_prager<double>(strength(material), cone_fit(material.drucker_prager_fit));
        const double third = cone.slope / 3, root = 1 / std::numbers::sqrt3;
        return ((root - third) * vertical - cone.limit) / (root + 2 * third);
    }
    case scene::MaterialModel::mohr_coulomb:
    case scene::MaterialModel::bolton:
    {
        const double sine   = std::sin(initial_friction_angle_deg(material) * std::numbers::pi / 180);
        const double active = (1 - sine) / (1 + sine);
        return active * vertical - 2 * material.cohesion * std::sqrt(active);
    }
    case scene::MaterialModel::elastic:
    case scene::MaterialModel::rigid:
        break;
    }
    return 0;
}

template<class Real>
std::vector<mpm::MaterialParameters<Real>> law_parameters(const scene::Scene& scene)
{
    std::vector<mpm::MaterialParameters<Real>> parameters;
    parameters.reserve(scene.materials.size());
    for (const scene::Material& material : scene.materials) { parameters.push_back(law_of<Real>(material)); }
    return parameters;
}

template std::vector<mpm::MaterialParameters<float>>  law_parameters(const scene::Scene&);
template std::vector<mpm::MaterialParameters<double>> law_parameters(const scene::Scene&);

double damping_ratio(double restitution)
{
    const auto gives = [](double zeta)
    {
        if (zeta < 1)
        {
            const double w = std::sqrt(1 - zeta * zeta);
            return std::exp(-(zeta / w) * (std::numbers::pi - std::atan2(2 * zeta * w, 1 - 2 * zeta * zeta)));
        }
        const double s = std::sqrt(zeta * zeta - 1);
        return s > 0 ? std::exp(-2 * zeta / s * std::atanh(s / zeta)) : std::exp(-2.0);
    };
    double low = 0, high = 4;
    for (int bisection = 0; bisection < 60; ++bisection)
    {
        const double middle                        = 0.5 * (low + high);
        (gives(middle) > restitution ? low : high) = middle;
    }
    return restitution >= 1 ? 0 : low;
}

std::vector<dem::PairProperties> pair_properties(const scene::Scene& scene, std::size_t phase)
{
    const auto                       contacts = scene::contacts_in(scene, phase);
    const std::size_t                count    = scene.materials.size();
    std::vector<dem::PairProperties> table((count + 1) * (count + 1));
    const Compliance                 wall{0, 0};
    for (std::size_t a = 0; a < count; ++a)
    {
        const scene::Material& first = scene.materials[a];
        for (std::size_t b = 0; b < count; ++b)
        {
            const scene::Material& second = scene.materials[b];
            table[a * (count + 1) + b] =
                pair(scene::contact_of(contacts, first.family, second.family), compliance(first), compliance(second));
        }
        const auto against_wall = pair(scene::contact_of(contacts, first.family, "wall"), compliance(first), wall);
        table[a * (count + 1) + count] = against_wall;
        table[count * (count + 1) + a] = against_wall;
    }
    return table;
}

double compression_wave_speed(const scene::Material& material)
{
    return mpm::make_elasticity<double>(material.young, material.poisson, material.density, material.young_pressure)
        .wave_speed;
}

double pic_rate(const scene::Scene& scene, const Sand& sand)
{
    if (scene.numerics.transfer == scene::Transfer::apic) { return std::numeric_limits<double>::infinity(); }
    std::set<std::uint8_t> present;
    for (const PointRow& row : sand.rows) { present.insert(sand.kind_of(row).material); }
    double largest = 0;
    for (const std::uint8_t m : present)
    {
        const scene::Material& material = scene.materials[m];
        const bool             granular = scene::is_granular(material.model);
        const double           factor   = scene.numerics.pic_rate.value_or(granular ? 0.2 : 0.04);
        largest = std::max(largest, factor * compression_wave_speed(material) / scene.grid.finest());
    }
    return largest;
}

double pic_share(double rate, double dt) { return std::isinf(rate) ? 1 : rate * dt / (1 + rate * dt); }

} // namespace tread::world
