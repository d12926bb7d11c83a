#pragma once

#include "scene/scene.hpp"

// Closed-form bearing capacity and contact mechanics of a body at rest, used to predict its contact patch before a
// run.
namespace tread::world
{

/// Bearing capacity factors of Terzaghi's formula q = c N_c + gamma z N_q + gamma b/2 N_gamma.
struct BearingFactors
{
    double cohesion;  ///< N_c: Prandtl; 2 + pi without friction
    double surcharge; ///< N_q: Reissner
    double weight;    ///< N_gamma: Hansen's 1.5 (N_q - 1) tan(phi)
};

BearingFactors bearing_factors(double friction_angle_deg);

/// Round body on a bed: a wheel (width > 0) or a ball (width = 0).
struct RoundBody
{
    double radius; ///< m
    double width;  ///< m, along the axle
    double load;   ///< N
};

/// Contact patch of a body at rest, as a rectangle of the same area where it is round.
struct Patch
{
    double sinkage; ///< m
    double length;  ///< m, along the rolling direction
    double width;   ///< m
    bool   carried; ///< false: the soil does not carry the load at any sinkage up to the axle

    double area() const; ///< m2
};

/// Patch on granular soil: the load equals the bearing capacity times the area of the sinkage's chord. The shorter
/// side of the patch is the footing's width, and the sinkage its depth.
Patch bearing_patch(const scene::Material& soil, double gravity, const RoundBody& body);

/// Patch on elastic ground, of a rigid ball or cylinder (Hertz).
Patch hertz_patch(const scene::Material& ground, const RoundBody& body);

} // namespace tread::world
