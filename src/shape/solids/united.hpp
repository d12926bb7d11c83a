#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "shape/distance/mesh_distance.hpp"
#include "shape/solids/solid.hpp"

// The union of solids.
namespace tread::shape
{

/// Position of a solid in another frame: x' = at + scale * rotation * x.
struct Placing
{
    double          scale;
    Eigen::Matrix3d rotation;
    Eigen::Vector3d at; ///< m
};

/// Moves a solid, with its mass properties, into another frame.
void place(Solid& solid, const Placing& placing);

/// Unites solids into one whose surface is the boundary of what any of them holds, and which keeps them as
/// `united`. The mass properties are the sum of theirs, less what several of them hold, which is sampled: exact where
/// they do not overlap. InputError, naming `origin`, if nothing is left.
Solid united(std::vector<Solid> solids, const std::string& origin);

/// Precomputed data for signed distances to a union.
struct UnitedDistance
{
    std::vector<MeshDistance> parts;
    TriangleTree              boundary;
    double                    finest; ///< m, resolution of the boundary where parts meet
};

UnitedDistance prepare_united_distance(const Solid& solid);

/// Signed distance (m) to a union: outside it the least of the distances to the parts, which is exact. Inside, the
/// depth in the deepest part or, if that is more, the distance to the boundary less its resolution: so a depth is
/// right within the resolution, also where parts only touch.
double signed_distance(const UnitedDistance& distance, const Eigen::Vector3d& point);

} // namespace tread::shape
