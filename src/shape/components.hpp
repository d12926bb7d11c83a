#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "shape/mesh.hpp"

// Parts of a mesh, and which way round they are.
namespace tread::shape
{

/// Triangles joined through edges that exactly two of them use.
struct Components
{
    std::size_t               count = 0;
    std::vector<std::size_t>  of;     ///< of each triangle
    std::vector<std::uint8_t> turned; ///< of each triangle: 1 = wound against the first triangle of its component
    std::size_t               one_sided = 0; ///< edges at which no winding fits, as on a Moebius strip
};

Components find_components(const TriangleMesh& mesh);

/// m3, of each component, by signed tetrahedra from its middle; `turned` triangles count the other
/// way round.
std::vector<double> signed_volumes(const TriangleMesh& mesh, const Components& components);

/// All triangles of each component, or `most` of them, drawn at random by their areas from a fixed seed: every n-th
/// would see the same side of each tooth of a wheel.
std::vector<std::vector<std::size_t>> sample_triangles(const TriangleMesh& mesh, const Components& components,
                                                       std::size_t most);

/// For each component those that hold all of it, whichever way they face. Two that hold each other are the same solid,
/// of which the larger, then the first, is the holder. Components whose surfaces cross do not hold each other.
std::vector<std::vector<std::size_t>> find_holders(const TriangleMesh& mesh, const Components& components);

} // namespace tread::shape
