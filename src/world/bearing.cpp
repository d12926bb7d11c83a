#include "world/bearing.hpp"

#include "world/materials.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tread::world
{
namespace
{

/// Patch bounded by the chord of a sinkage.
Patch chord_patch(const RoundBody& body, double sinkage)
{
    const double chord = 2 * std::sqrt(std::max(0.0, sinkage * (2 * body.radius - sinkage)));
    if (body.width > 0) { return {sinkage, chord, body.width, true}; }
    const double side = 0.5 * std::sqrt(std::numbers::pi) * chord;
    return {sinkage, side, side, true};
}

} // namespace

double Patch::area() const { return length * width; }

BearingFactors bearing_factors(double friction_angle_deg)
{
    const double phi = friction_angle_deg * std::numbers::pi / 180;
    const double tan = std::tan(phi);
    if (tan < 1e-6) { return {2 + std::numbers::pi, 1, 0}; }
    const double surcharge =
        std::exp(std::numbers::pi * tan) * std::pow(std::tan(std::numbers::pi / 4 + phi / 2), 2); // N_q
    return {(surcharge - 1) / tan, surcharge, 1.5 * (surcharge - 1) * tan};
}

Patch bearing_patch(const scene::Material& soil, double gravity, const RoundBody& body)
{
    const BearingFactors factors  = bearing_factors(initial_friction_angle_deg(soil));
    const auto           capacity = [&](const Patch& patch)
    {
        const double breadth  = std::min(patch.length, patch.width);
        const double weight   = soil.density * gravity;
        const double pressure = soil.cohesion * factors.cohesion + weight * patch.sinkage * factors.surcharge +
                                0.5 * weight * breadth * factors.weight;
        return pressure * patch.area();
    };
    double low = 0, high = body.radius;
    if (capacity(chord_patch(body, high)) < body.load)
    {
        Patch deep   = chord_patch(body, high);
        deep.carried = false;
        return deep;
    }
    for (int halving = 0; halving < 60; ++halving)
    {
        const double middle                                            = 0.5 * (low + high);
        (capacity(chord_patch(body, middle)) < body.load ? low : high) = middle;
    }
    return chord_patch(body, high);
}

Patch hertz_patch(const scene::Material& ground, const RoundBody& body)
{
    const double stiffness = ground.young / (1 - ground.poisson * ground.poisson);
    if (body.width > 0)
    {
        const double half = std::sqrt(4 * body.load / body.width * body.radius / (std::numbers::pi * stiffness));
        return {half * half / (2 * body.radius), 2 * half, body.width, half < body.radius};
    }
    const double radius = std::cbrt(0.75 * body.load * body.radius / stiffness);
    const double side   = std::sqrt(std::numbers::pi) * radius;
    return {radius * radius / body.radius, side, side, radius < body.radius};
}

} // namespace tread::world
