#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "shape/mesh/mesh.hpp"

namespace tread::shape
{

/// Random features of a rock, drawn from its seed: planes that may cut its ball, and waves that may dent it.
struct RockCharacter
{
    struct Plane
    {
        Eigen::Vector3d normal;
        double          bite;   ///< relative rate at which it moves inwards with the cut, 0 to 1
        double          tiring; ///< decrease of that rate per unit of cut
    };
    struct Wave
    {
        Eigen::Vector3d number; ///< wave vector, rad per radius
        double          phase;
    };

    std::vector<Plane> planes;
    std::vector<Wave>  waves;
};

RockCharacter rock_character(std::uint64_t seed);

/// Parameters that are fitted to the requested form.
struct RockHandles
{
    double          cut     = 0; ///< depth of the cuts, 0 (none, a ball) to most_cut; the cut ball is always convex
    double          dent    = 0; ///< amplitude of the dents, 0 to most_dent; reduces the solidity
    Eigen::Matrix3d stretch = Eigen::Matrix3d::Identity(); ///< applied last; does not change the solidity
};

// Deeper cuts come so near the centre that rays meet faces at grazing angles; larger dents make spikes.
inline constexpr double most_cut = 0.72, most_dent = 0.7;

/// Triangles of a rock before it is stretched: directions from its centre, with vertices on the edges and corners of
/// the cuts.
TriangleMesh rock_directions(const RockCharacter& character, double cut, const Eigen::Matrix3d& stretch,
                             const TriangleMesh& sphere);

/// Surface of the rock along the vertices of `directions`, as rays from its centre.
TriangleMesh rock_surface(const RockCharacter& character, const RockHandles& handles, const TriangleMesh& directions);

} // namespace tread::shape
