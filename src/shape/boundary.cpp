#include "shape/boundary.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "shape/mesh_reader.hpp"
#include "shape/triangle.hpp"

namespace tread::shape
{
namespace
{

using Corners = std::array<Eigen::Vector3d, 3>;

/// Whether the projections on the axis leave each other free, or overlap by at most `slack` (m).
bool apart_along(const Eigen::Vector3d& axis, const Corners& one, const Corners& other, double slack)
{
    const auto [one_low, one_high]     = std::minmax({axis.dot(one[0]), axis.dot(one[1]), axis.dot(one[2])});
    const auto [other_low, other_high] = std::minmax({axis.dot(other[0]), axis.dot(other[1]), axis.dot(other[2])});
    return std::min(one_high, other_high) - std::max(one_low, other_low) <= slack * axis.norm();
}

/// Whether two triangles have more than `slack` in common, by separating axes: the normals, products of sides, and,
/// for triangles of one plane, the normals of the sides in it. Neighbours in a mesh have a rim in common, no more.
bool crosses(const Corners& one, const Corners& other, double slack)
{
    std::array<Eigen::Vector3d, 3> side, across;
    for (std::size_t i = 0; i < 3; ++i)
    {
        side[i]   = (one[(i + 1) % 3] - one[i]).normalized();
        across[i] = (other[(i + 1) % 3] - other[i]).normalized();
    }
    const Eigen::Vector3d normal = side[0].cross(side[1]), other_normal = across[0].cross(across[1]);
    const auto            apart    = [&](const Eigen::Vector3d& axis) { return apart_along(axis, one, other, slack); };
    constexpr double      parallel = 1e-6;
    if (normal.cross(other_normal).norm() <= parallel * normal.norm() * other_normal.norm())
    {
        // Of parallel planes, only one that both lie in.
        const double gap = std::abs(normal.dot(other[0] - one[0]));
        if (gap > slack * normal.norm()) { return false; }
        for (std::size_t i = 0; i < 3; ++i)
        {
            if (apart(normal.cross(side[i])) || apart(normal.cross(across[i]))) { return false; }
        }
        return true;
    }
    if (apart(normal) || apart(other_normal)) { return false; }
    for (const Eigen::Vector3d& a : side)
    {
        for (const Eigen::Vector3d& b : across)
        {
            const Eigen::Vector3d axis = a.cross(b);
            if (axis.norm() > parallel && apart(axis)) { return false; }
        }
    }
    return true;
}

struct BoundaryFinder
{
    const TriangleMesh& mesh;
    const WindingTree&  winding;
    double              finest;
    double              step; ///< m, from the surface to either side of it

    Corners corners_of(std::size_t triangle) const
    {
        return {corner(mesh, triangle, 0), corner(mesh, triangle, 1), corner(mesh, triangle, 2)};
    }

    /// The other triangles that cross this one.
    std::vector<Corners> find_crossing(std::size_t triangle) const
    {
        const Corners        own = corners_of(triangle);
        const Bounds         box{own[0].cwiseMin(own[1]).cwiseMin(own[2]), own[0].cwiseMax(own[1]).cwiseMax(own[2])};
        std::vector<Corners> crossing;
        for (const std::int32_t other : triangles_touching(winding.tree, box, mesh.triangles.size()))
        {
            if (static_cast<std::size_t>(other) == triangle) { continue; }
            const Corners corners = corners_of(static_cast<std::size_t>(other));
            if (crosses(own, corners, step)) { crossing.push_back(corners); }
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

    /// Adds what bounds the solid of a piece that `crossing` may cross.
    void collect(const Corners& piece, const std::vector<Corners>& crossing, std::vector<Corners>& kept) const
    {
        std::vector<Corners> still;
        std::copy_if(crossing.begin(), crossing.end(), std::back_inserter(still),
                     [&](const Corners& other) { return crosses(piece, other, step); });
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
    for (std::size_t t = 0; t < count; ++t) { finder.collect(finder.corners_of(t), finder.find_crossing(t), kept[t]); }
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
