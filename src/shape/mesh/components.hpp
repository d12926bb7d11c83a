#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "shape/mesh/mesh.hpp"

// Connected components of a mesh and their orientation.
namespace tread::shape
{

/// Connected components: triangles joined through edges that exactly two of them use.
struct Components
{
    std::size_t               count = 0;
    std::vector<std::size_t>  of;     ///< component of each triangle
    std::vector<std::uint8_t> turned; ///< for each triangle: 1 = wound against the first triangle of its component
    std::size_t               one_sided = 0; ///< edges at which no consistent winding exists, as on a Moebius strip
};

Components find_components(const TriangleMesh& mesh);

/// Volume (m3) of each component, by signed tetrahedra from its middle; `turned` triangles count with the opposite
/// sign.
std::vector<double> signed_volumes(const TriangleMesh& mesh, const Components& components);

/// Samples triangles of each component: all of them, or `most` drawn at random by area from a fixed seed. Taking every
/// n-th would select the same side of each tooth of a wheel.
std::vector<std::vector<std::size_t>> sample_triangles(const TriangleMesh& mesh, const Components& components,
                                                       std::size_t most);

/// Lists for each component those that contain all of it, whichever way they face. Two that contain each other are the
/// same solid; the larger, or else the first, is the holder. Components whose surfaces cross do not contain each other.
std::vector<std::vector<std::size_t>> find_holders(const TriangleMesh& mesh, const Components& components);

} // namespace tread::shape
