#pragma once

#include <cstdint>

#include "backend/array.hpp"
#include "backend/vector.hpp"

// Templates (see shape/template.hpp) as item functions see them: at scale 1, in the body frame.
namespace tread::dem
{

/// Grid of a template's signed distance field, laid out as shape::SignedDistanceGrid.
struct SdfGridView
{
    Vec3<double>        origin;
    double              spacing;         ///< m
    double              inverse_spacing; ///< 1/m
    double              steepest;        ///< maximum |gradient| of the interpolant outside, where corners are exact
    std::int32_t        nodes[3];
    const float*        values; ///< m, negative inside
    const std::int32_t* slots;  ///< slots of the bricks; null = dense, and the next three are unused
    const float*        corners;
    std::int32_t        bricks[3];
    double              fine_reach; ///< m
};

struct TemplateView
{
    SdfGridView         sdf;
    std::int32_t        node_count;
    std::int32_t        part_count;
    const Vec3<double>* node_positions;
    const double*       node_areas;
    const Vec3<double>* part_centres; ///< of bounding spheres, one per eight nodes, in their order
    const double*       part_radii;
    Vec3<double>        low; ///< bounding box
    Vec3<double>        high;
    double              bounding_radius;
    double              equivalent_radius; ///< R of the contact law
    double              sphere_radius;     ///< m, of an exact sphere; 0 for any other shape
    bool                concave;           ///< concave enough to touch another body in several places
};

/// Contact parameters of a pair of materials; symmetric in the pair.
struct PairProperties
{
    double effective_young; ///< E*, 1/E* = sum (1 - nu^2)/E; for rigid materials that side is zero
    double effective_shear; ///< G*, 1/G* = sum (2 - nu)/G
    double friction;        ///< Coulomb coefficient
    double damping_ratio;   ///< damping ratio zeta of the body-body law, from the restitution

    double rolling_friction = 0;    ///< rolling friction coefficient mu_r
    bool   touch            = true; ///< false: the search for contacts leaves the pair out
};

/// Table of materials x materials, row-major; the last row and column are the domain's walls (rigid).
struct PairTable
{
    const PairProperties* values;
    std::int32_t          materials; ///< including the walls

    TREAD_HD const PairProperties& operator()(std::int32_t a, std::int32_t b) const
    {
        return values[a * materials + b];
    }
    TREAD_HD std::int32_t wall() const { return materials - 1; }
};

/// A wall of the domain: bodies are kept where normal . x >= offset.
struct Plane
{
    Vec3<double> normal; ///< unit, into the domain
    double       offset; ///< m
    bool         slip;   ///< frictionless
};

/// Parameters of the body-body law that hold for the whole scene.
struct ContactOptions
{
    double hertz_factor;   ///< 1, or 1/sqrt(2) for the paper's Eq. 7
    double linear_overlap; ///< d0/R* below which the traction is linear in d
};

} // namespace tread::dem
