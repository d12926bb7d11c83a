#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "shape/mesh.hpp"

namespace tread::shape
{

/// What a seed decides of a rock: the planes that may cut its ball, and the waves that may dent it.
struct RockCharacter
{
    struct Plane
    {
        Eigen::Vector3d normal;
        double          bite;   ///< how fast it moves in with the cut, 0 to 1
        double          tiring; ///< by how much slower for every unit of cut
    };
    struct Wave
    {
        Eigen::Vector3d number; ///< rad a radius
        double          phase;
    };

    std::vector<Plane> planes;
    std::vector<Wave>  waves;
};

RockCharacter rock_character(std::uint64_t seed);

/// What is chosen to meet the form that is asked for.
struct RockHandles
{
    double          cut     = 0; ///< depth of the cuts, 0 (none, a ball) to most_cut; convex whatever it is
    double          dent    = 0; ///< amplitude of the dents, 0 to most_dent; what takes away from the solidity
    Eigen::Matrix3d stretch = Eigen::Matrix3d::Identity(); ///< applied last; leaves the solidity as it is
};

// Deeper cuts come so near the centre that faces are seen at grazing angles; larger dents make spikes.
inline constexpr double most_cut = 0.72, most_dent = 0.7;

/// The triangles of a rock before it is stretched: directions from its centre, with vertices on the edges and corners
/// that the cuts make.
TriangleMesh rock_directions(const RockCharacter& character, double cut, const Eigen::Matrix3d& stretch,
                             const TriangleMesh& sphere);

/// Surface of the rock seen from its centre in the directions of the vertices of `directions`.
TriangleMesh rock_surface(const RockCharacter& character, const RockHandles& handles, const TriangleMesh& directions);

} // namespace tread::shape
