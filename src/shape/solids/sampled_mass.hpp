#pragma once

#include <functional>

#include "shape/distance/mesh_distance.hpp"
#include "shape/solids/mass_properties.hpp"

namespace tread::shape
{

/// Integrals of 1 (m3), x (m4) and x x^T (m5) over a region, about a point.
struct Moments
{
    double          volume = 0;
    Eigen::Vector3d first  = Eigen::Vector3d::Zero();
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();

    Moments& operator+=(const Moments& other);
    Moments& operator-=(const Moments& other);
};

/// Moments of a solid of density 1 about `origin`.
Moments moments_of(const MassProperties& mass, const Eigen::Vector3d& origin);

/// Mass properties from moments about `origin`; the volume must not be 0.
MassProperties mass_of(const Moments& moments, const Eigen::Vector3d& origin);

/// Mass properties of the interior of a surface that need not be closed: the box is divided into cubes, and those at
/// the surface are subdivided down to a 128th of its longest extent. Within 0.1 % for the shapes of the tests.
MassProperties sampled_mass_properties(const Bounds& box, const MeshDistance& distance);

/// Moments about `origin` of the region in the box where `depth` is positive, by the same cubes. Its magnitude is at
/// most the distance to the region's surface, so that it may underestimate depths. Where it is only just not positive,
/// as between solids that touch, nothing counts.
Moments sampled_moments(const Bounds& box, const Eigen::Vector3d& origin,
                        const std::function<double(const Eigen::Vector3d&)>& depth);

} // namespace tread::shape
