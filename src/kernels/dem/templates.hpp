#pragma once

#include <cstdint>

#include "backend/array.hpp"
#include "backend/vector.hpp"

// Templates (see shape/template.hpp) as item functions see them, at scale 1 in the body frame.
namespace tread::dem
{

struct TemplateView
{
    Vec3<double>        sdf_origin;
    double              sdf_spacing;         ///< m
    double              sdf_inverse_spacing; ///< 1/m
    double              sdf_steepest;        ///< largest |gradient| of the interpolant outside, where corners are exact
    std::int32_t        sdf_nodes[3];
    const float*        sdf_values; ///< m, negative inside; laid out as in shape::SignedDistanceGrid
    const std::int32_t* sdf_slots;  ///< of the bricks; null = dense, and the four below mean nothing
    const float*        sdf_corners;
    std::int32_t        sdf_bricks[3];
    double              sdf_fine_reach; ///< m
    std::int32_t        node_count;
    std::int32_t        cluster_count;
    const Vec3<double>* node_positions;
    const double*       node_areas;
    const Vec3<double>* cluster_centres; ///< of 32 nodes each, in order
    const double*       cluster_radii;
    Vec3<double>        low; ///< bounding box
    Vec3<double>        high;
    double              bounding_radius;
    double              equivalent_radius; ///< R of the contact law
    double              sphere_radius;     ///< m, of an exact sphere; 0 of any other shape
    bool                concave;           ///< enough to touch another body in separate places
};

/// What a pair of materials needs in the contact laws; symmetric in the pair.
struct PairProperties
{
    double effective_young; ///< E*, 1/E* = sum (1 - nu^2)/E; for rigid materials that side is zero
    double effective_shear; ///< G*, 1/G* = sum (2 - nu)/G
    double friction;        ///< Coulomb
    double damping_ratio;   ///< zeta of the body-body law, from the restitution

    double rolling_friction = 0; ///< mu_r, of the moment that resists rolling
};

/// materials x materials, row-major; the last row and column is the domain's wall (rigid).
struct PairTable
{
    const PairProperties* values;
    std::int32_t          materials; ///< walls included

    TREAD_HD const PairProperties& operator()(std::int32_t a, std::int32_t b) const
    {
        return values[a * materials + b];
    }
    TREAD_HD std::int32_t wall() const { return materials - 1; }
};

/// A wall of the domain: bodies stay where normal . x >= offset.
struct Plane
{
    Vec3<double> normal; ///< unit, into the domain
    double       offset; ///< m
    bool         slip;   ///< no friction
};

/// Numbers of the body-body law that hold for the whole scene.
struct ContactOptions
{
    double hertz_factor;   ///< 1, or 1/sqrt(2) for the paper's Eq. 7
    double linear_overlap; ///< d0/R* under which the traction is linear in d
};

} // namespace tread::dem
