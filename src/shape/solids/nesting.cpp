#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "shape/distance/winding_number.hpp"
#include "shape/mesh/components.hpp"
#include "shape/mesh/triangle.hpp"
#include "shape/mesh/triangle_crossing.hpp"

namespace tread::shape
{
namespace
{

/// Splits a mesh into one mesh per component; their triangles share no vertices.
std::vector<TriangleMesh> split(const TriangleMesh& mesh, const Components& components)
{
    std::vector<TriangleMesh> parts(components.count);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    {
        TriangleMesh& part  = parts[components.of[t]];
        const auto    first = static_cast<std::int32_t>(part.vertices.size());
        for (std::size_t c = 0; c < 3; ++c) { part.vertices.push_back(corner(mesh, t, c)); }
        part.triangles.push_back({first, first + 1, first + 2});
    }
    return parts;
}

/// Bounding boxes of the parts as a mesh of their diagonals, for the tree's search.
TriangleMesh diagonals(const std::vector<Bounds>& boxes)
{
    TriangleMesh mesh;
    for (const Bounds& box : boxes)
    {
        const auto first = static_cast<std::int32_t>(mesh.vertices.size());
        mesh.vertices.push_back(box.low);
        mesh.vertices.push_back(box.high);
        mesh.triangles.push_back({first, first + 1, first});
    }
    return mesh;
}

bool lies_in(const Bounds& inner, const Bounds& outer, double slack)
{
    return (inner.low.array() >= outer.low.array() - slack).all() &&
           (inner.high.array() <= outer.high.array() + slack).all();
}

class HolderSearch
{
public:
    HolderSearch(const TriangleMesh& mesh, const Components& components)
        : step_(1e-6 * bounds(mesh).extent().maxCoeff())
        , samples_(sample_triangles(mesh, components, most))
        , volumes_(signed_volumes(mesh, components))
        , parts_(split(mesh, components))
        , windings_(parts_.size())
        , mesh_(mesh)
    {
        for (const TriangleMesh& part : parts_) { boxes_.push_back(bounds(part)); }
    }

    std::vector<std::vector<std::size_t>> run()
    {
        std::vector<std::vector<std::size_t>> holders(parts_.size());
        const TriangleTree                    tree = build_tree(diagonals(boxes_));
        for (std::size_t p = 0; p < parts_.size(); ++p)
        {
            for (const std::int32_t found : triangles_touching(tree, boxes_[p], parts_.size()))
            {
                const auto q = static_cast<std::size_t>(found);
                if (q != p && holds(q, p)) { holders[p].push_back(q); }
            }
        }
        return holders;
    }

private:
    static constexpr std::size_t most = 1024; ///< most triangles of a part that are tested

    bool holds(std::size_t outer, std::size_t inner)
    {
        const double own = std::abs(volumes_[outer]), other = std::abs(volumes_[inner]);
        if (own < other || (own == other && outer > inner) || own == 0) { return false; }
        return lies_in(boxes_[inner], boxes_[outer], step_) && samples_lie_in(outer, inner) && !cross(outer, inner);
    }

    const WindingTree& winding(std::size_t part)
    {
        if (!windings_[part]) { windings_[part] = build_winding_tree(parts_[part]); }
        return *windings_[part];
    }

    /// On a face shared with the holder the winding number is 1/2.
    bool samples_lie_in(std::size_t outer, std::size_t inner)
    {
        constexpr double   least = 0.4;
        const WindingTree& tree  = winding(outer);
        return std::all_of(samples_[inner].begin(), samples_[inner].end(),
                           [&](std::size_t t)
                           { return std::abs(winding_number_on(tree, corners(mesh_, t), step_)) > least; });
    }

    bool cross(std::size_t outer, std::size_t inner)
    {
        const TriangleTree& tree = winding(outer).tree;
        for (std::size_t t = 0; t < parts_[inner].triangles.size(); ++t)
        {
            const Corners own = corners(parts_[inner], t);
            for (const std::int32_t other : triangles_touching(tree, bounds(own), parts_[outer].triangles.size()))
            {
                const Corners theirs = corners(parts_[outer], static_cast<std::size_t>(other));
                if (crosses(own, theirs, step_) && !coplanar(own, theirs)) { return true; }
            }
        }
        return false;
    }

    /// Whether the first lies in the plane of the second, so that they share a face.
    bool coplanar(const Corners& one, const Corners& other) const
    {
        const Eigen::Vector3d normal = (other[1] - other[0]).cross(other[2] - other[0]).normalized();
        return std::all_of(one.begin(), one.end(),
                           [&](const Eigen::Vector3d& corner)
                           { return std::abs(normal.dot(corner - other[0])) <= step_; });
    }

    double step_; ///< m, offset from a surface to either side; smallest depth of a crossing
    std::vector<std::vector<std::size_t>>   samples_;
    std::vector<double>                     volumes_; ///< m3
    std::vector<TriangleMesh>               parts_;
    std::vector<std::optional<WindingTree>> windings_; ///< of parts that may contain others
    std::vector<Bounds>                     boxes_;
    const TriangleMesh&                     mesh_;
};

} // namespace

std::vector<std::vector<std::size_t>> find_holders(const TriangleMesh& mesh, const Components& components)
{
    if (components.count < 2) { return std::vector<std::vector<std::size_t>>(components.count); }
    return HolderSearch(mesh, components).run();
}

} // namespace tread::shape
