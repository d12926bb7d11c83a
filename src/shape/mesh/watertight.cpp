#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "shape/mesh/half_edges.hpp"
#include "shape/mesh/mesh.hpp"
#include "shape/mesh/triangle.hpp"
#include "shape/solids/mass_properties.hpp"

namespace tread::shape
{
namespace
{

/// Count of a defect, and its first position.
struct Defect
{
    const char*     what;
    std::size_t     count = 0;
    Eigen::Vector3d first = Eigen::Vector3d::Zero();

    void add(const Eigen::Vector3d& place)
    {
        if (count == 0) { first = place; }
        ++count;
    }
};

using HalfEdgeIterator = std::vector<HalfEdge>::const_iterator;

std::vector<Defect> edge_defects(const TriangleMesh& mesh)
{
    Defect open{"open edges (used by one triangle)"};
    Defect crowded{"non-manifold edges (used by more than two triangles)"};
    Defect flipped{"edges between triangles of opposite orientation"};
    for_each_edge(sorted_half_edges(mesh),
                  [&](HalfEdgeIterator first, HalfEdgeIterator last)
                  {
                      const Eigen::Vector3d middle = 0.5 * (mesh.vertices[static_cast<std::size_t>(first->low)] +
                                                            mesh.vertices[static_cast<std::size_t>(first->high)]);
                      const auto            uses   = last - first;
                      if (uses == 1) { open.add(middle); }
                      else if (uses > 2) { crowded.add(middle); }
                      else if (runs_upwards(mesh, *first) == runs_upwards(mesh, *(first + 1))) { flipped.add(middle); }
                  });
    return {open, crowded, flipped};
}

Defect degenerate_triangles(const TriangleMesh& mesh)
{
    Defect degenerate{"degenerate triangles (no area)"};
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    {
        if (!is_degenerate(mesh, t)) { continue; }
        degenerate.add((corner(mesh, t, 0) + corner(mesh, t, 1) + corner(mesh, t, 2)) / 3);
    }
    return degenerate;
}

} // namespace

std::string describe_defects(const TriangleMesh& mesh)
{
    std::vector<Defect> defects = edge_defects(mesh);
    defects.push_back(degenerate_triangles(mesh));
    std::string found;
    for (const Defect& defect : defects)
    {
        if (defect.count == 0) { continue; }
        found += fmt::format("\n  {} {}, the first at ({:.6g}, {:.6g}, {:.6g}) m", defect.count, defect.what,
                             defect.first.x(), defect.first.y(), defect.first.z());
    }
    return found;
}

void require_watertight(const TriangleMesh& mesh, const std::string& origin)
{
    if (mesh.triangles.empty()) { throw InputError(fmt::format("{}: the mesh has no triangles", origin)); }
    const std::string found = describe_defects(mesh);
    if (!found.empty()) { throw InputError(fmt::format("{}: the mesh is not watertight:{}", origin, found)); }

    const double volume = mass_properties(mesh).volume;
    if (!(volume > 0))
    {
        throw InputError(fmt::format("{}: the mesh is inside out: its volume is {:.6g} m3; it must be positive, with "
                                     "triangles counter-clockwise seen from outside",
                                     origin, volume));
    }
}

} // namespace tread::shape
