#include "shape/solids/boundary.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "shape/mesh/mesh_reader.hpp"
#include "shape/mesh/triangle.hpp"
#include "shape/mesh/triangle_crossing.hpp"

namespace tread::shape
{
namespace
{

struct BoundaryFinder
{
    const TriangleMesh& mesh;
    const WindingTree&  winding;
    double              finest;
    double              step; ///< m, from the surface to either side of it

    /// Other triangles that cross this one.
    std::vector<Corners> find_crossing(std::size_t triangle) const
    {
        const Corners        own = corners(mesh, triangle);
        const Bounds         box = bounds(own);
        std::vector<Corners> crossing;
        for (const std::int32_t other : triangles_touching(winding.tree, box, mesh.triangles.size()))
        {
            if (static_cast<std::size_t>(other) == triangle) { continue; }
            const Corners theirs = corners(mesh, static_cast<std::size_t>(other));
            if (crosses(own, theirs, step)) { crossing.push_back(theirs); }
        }
        return crossing;
    }

    bool bounds_the_solid(const Corners& piece) const
    {
        const Eigen::Vector3d middle = (piece[0] + piece[1] + piece[2]) / 3;
        const Eigen::Vector3d normal = (piece[1] - piece[0]).cross(piece[2] - piece[0]).normalized();
        const bool            before = winding_number(winding, middle + step * normal) > 0.5;
        return before != (winding_number(winding, middle - step * normal) > 0.5);
    }

    /// Adds the parts of a piece, which `crossing` may cross, that bound the solid. A triangle that covers all of a
    /// piece has no edge in it, and both of its sides are the same everywhere: it need not be bisected for that one.
    void collect(const Corners& piece, const std::vector<Corners>& crossing, std::vector<Corners>& kept) const
    {
        std::vector<Corners> still;
        std::copy_if(crossing.begin(), crossing.end(), std::back_inserter(still),
                     [&](const Corners& other)
                     { return crosses(piece, other, step) && !lies_within(piece, other, step); });
        const std::array<double, 3> lengths{(piece[1] - piece[0]).norm(), (piece[2] - piece[1]).norm(),
                                            (piece[0] - piece[2]).norm()};
        const auto                  longest =
            static_cast<std::size_t>(std::max_element(lengths.begin(), lengths.end()) - lengths.begin());
        if (still.empty() || lengths[longest] <= finest)
        {
            if (bounds_the_solid(piece)) { kept.push_back(piece); }
            return;
        }
        const Eigen::Vector3d& a = piece[longest];
        const Eigen::Vector3d& b = piece[(longest + 1) % 3];
        const Eigen::Vector3d& c = piece[(longest + 2) % 3];
        const Eigen::Vector3d  m = 0.5 * (a + b);
        collect({a, m, c}, still, kept);
        collect({m, b, c}, still, kept);
    }
};

} // namespace

TriangleMesh find_boundary(const TriangleMesh& mesh, const WindingTree& winding, double finest)
{
    const BoundaryFinder              finder{mesh, winding, finest, 1e-6 * bounds(mesh).extent().maxCoeff()};
    const std::size_t                 count = mesh.triangles.size();
    std::vector<std::vector<Corners>> kept(count);
#pragma omp parallel for schedule(dynamic, 64)
    for (std::size_t t = 0; t < count; ++t) { finder.collect(corners(mesh, t), finder.find_crossing(t), kept[t]); }
    TriangleMesh boundary;
    for (const auto& pieces : kept)
    {
        for (const Corners& piece : pieces)
        {
            const auto first = static_cast<std::int32_t>(boundary.vertices.size());
            boundary.vertices.insert(boundary.vertices.end(), piece.begin(), piece.end());
            boundary.triangles.push_back({first, first + 1, first + 2});
        }
    }
    return weld(boundary);
}

} // namespace tread::shape
