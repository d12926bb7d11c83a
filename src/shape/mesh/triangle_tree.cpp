#include "shape/mesh/triangle_tree.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

#include "shape/mesh/triangle.hpp"

namespace tread::shape
{
namespace
{

constexpr std::int32_t leaf_size = 4;

struct Builder
{
    const TriangleMesh&          mesh;
    std::vector<Eigen::Vector3d> centres;
    TriangleTree&                tree;

    void enclose(TriangleTree::Node& node, std::int32_t first, std::int32_t last) const
    {
        node.low  = corner(mesh, index(first), 0);
        node.high = node.low;
        for (std::int32_t i = first; i < last; ++i)
        {
            for (std::size_t c = 0; c < 3; ++c)
            {
                node.low  = node.low.cwiseMin(corner(mesh, index(i), c));
                node.high = node.high.cwiseMax(corner(mesh, index(i), c));
            }
        }
    }

    std::size_t index(std::int32_t entry) const
    {
        return static_cast<std::size_t>(tree.triangles[static_cast<std::size_t>(entry)]);
    }

    /// Splits the entries at the median centre along the axis of largest spread.
    std::int32_t split(std::int32_t first, std::int32_t last)
    {
        Eigen::Vector3d low = centres[index(first)], high = low;
        for (std::int32_t i = first; i < last; ++i)
        {
            low  = low.cwiseMin(centres[index(i)]);
            high = high.cwiseMax(centres[index(i)]);
        }
        Eigen::Index axis;
        (high - low).maxCoeff(&axis);
        const std::int32_t middle = first + (last - first) / 2;
        const auto         begin  = tree.triangles.begin();
        std::nth_element(begin + first, begin + middle, begin + last,
                         [&](std::int32_t a, std::int32_t b)
                         {
                             return std::pair(centres[static_cast<std::size_t>(a)][axis], a) <
                                    std::pair(centres[static_cast<std::size_t>(b)][axis], b);
                         });
        return middle;
    }

    void build(std::size_t node, std::int32_t first, std::int32_t last)
    {
        enclose(tree.nodes[node], first, last);
        if (last - first <= leaf_size)
        {
            tree.nodes[node].first = first;
            tree.nodes[node].count = last - first;
            return;
        }
        const std::int32_t middle = split(first, last);
        const std::size_t  left   = tree.nodes.size();
        tree.nodes[node].first    = static_cast<std::int32_t>(left);
        tree.nodes[node].count    = 0;
        tree.nodes.resize(left + 2);
        build(left, first, middle);
        build(left + 1, middle, last);
    }
};

struct Candidate
{
    Eigen::Vector3d point;
    Feature         feature;
};

/// Closest point of a triangle, by Voronoi region (Ericson 2005, Real-Time Collision Detection, 5.1.5).
Candidate closest_on_triangle(const std::array<Eigen::Vector3d, 3>& corners, const Eigen::Vector3d& p)
{
    const auto& [a, b, c]    = corners;
    const Eigen::Vector3d ab = b - a, ac = c - a;
    const Eigen::Vector3d ap = p - a, bp = p - b, cp = p - c;
    const double          ab_ap = ab.dot(ap), ac_ap = ac.dot(ap);
    if (ab_ap <= 0 && ac_ap <= 0) { return {a, Feature::corner_0}; }
    const double ab_bp = ab.dot(bp), ac_bp = ac.dot(bp);
    if (ab_bp >= 0 && ac_bp <= ab_bp) { return {b, Feature::corner_1}; }
    const double weight_c = ab_ap * ac_bp - ab_bp * ac_ap;
    if (weight_c <= 0 && ab_ap >= 0 && ab_bp <= 0) { return {a + ab_ap / (ab_ap - ab_bp) * ab, Feature::side_0}; }
    const double ab_cp = ab.dot(cp), ac_cp = ac.dot(cp);
    if (ac_cp >= 0 && ab_cp <= ac_cp) { return {c, Feature::corner_2}; }
    const double weight_b = ab_cp * ac_ap - ab_ap * ac_cp;
    if (weight_b <= 0 && ac_ap >= 0 && ac_cp <= 0) { return {a + ac_ap / (ac_ap - ac_cp) * ac, Feature::side_2}; }
    const double weight_a = ab_bp * ac_cp - ab_cp * ac_bp;
    const double from_b = ac_bp - ab_bp, from_c = ab_cp - ac_cp;
    if (weight_a <= 0 && from_b >= 0 && from_c >= 0)
    {
        return {b + from_b / (from_b + from_c) * (c - b), Feature::side_1};
    }
    const double sum = weight_a + weight_b + weight_c;
    return {a + weight_b / sum * ab + weight_c / sum * ac, Feature::face};
}

double squared_distance(const TriangleTree::Node& node, const Eigen::Vector3d& point)
{
    return (node.low - point).cwiseMax(point - node.high).cwiseMax(0.0).squaredNorm();
}

void search_leaf(const TriangleTree& tree, const TriangleTree::Node& leaf, const Eigen::Vector3d& point,
                 ClosestPoint& best)
{
    for (std::int32_t i = leaf.first; i < leaf.first + leaf.count; ++i)
    {
        const auto      at        = static_cast<std::size_t>(i);
        const Candidate candidate = closest_on_triangle(tree.corners[at], point);
        const double    squared   = (candidate.point - point).squaredNorm();
        if (squared < best.squared_distance)
        {
            best = {candidate.point, squared, tree.triangles[at], candidate.feature};
        }
    }
}

} // namespace

TriangleTree build_tree(const TriangleMesh& mesh)
{
    TriangleTree tree;
    const auto   count = mesh.triangles.size();
    tree.triangles.resize(count);
    std::iota(tree.triangles.begin(), tree.triangles.end(), 0);
    Builder builder{mesh, {}, tree};
    for (std::size_t t = 0; t < count; ++t)
    {
        builder.centres.push_back((corner(mesh, t, 0) + corner(mesh, t, 1) + corner(mesh, t, 2)) / 3);
    }
    tree.nodes.resize(1);
    builder.build(0, 0, static_cast<std::int32_t>(count));
    for (const std::int32_t triangle : tree.triangles)
    {
        const auto t = static_cast<std::size_t>(triangle);
        tree.corners.push_back({corner(mesh, t, 0), corner(mesh, t, 1), corner(mesh, t, 2)});
    }
    return tree;
}

ClosestPoint closest_point(const TriangleTree& tree, const Eigen::Vector3d& point, double within)
{
    struct Pending
    {
        std::int32_t node;
        double       squared_distance;
    };
    // Halves differ by at most one triangle, so 2^31 triangles are 31 levels, with one pending sibling each.
    std::array<Pending, 64> stack;
    std::size_t             top = 0;
    ClosestPoint            best{point, within * within, -1, Feature::face};

    Pending at{0, squared_distance(tree.nodes[0], point)};
    while (true)
    {
        const TriangleTree::Node& node = tree.nodes[static_cast<std::size_t>(at.node)];
        if (at.squared_distance < best.squared_distance && node.count == 0)
        {
            Pending near{node.first, squared_distance(tree.nodes[static_cast<std::size_t>(node.first)], point)};
            Pending far{node.first + 1, squared_distance(tree.nodes[static_cast<std::size_t>(node.first) + 1], point)};
            if (far.squared_distance < near.squared_distance) { std::swap(near, far); }
            if (far.squared_distance < best.squared_distance) { stack[top++] = far; }
            at = near;
            continue;
        }
        if (at.squared_distance < best.squared_distance) { search_leaf(tree, node, point, best); }
        if (top == 0) { break; }
        at = stack[--top];
    }
    return best;
}

std::vector<std::int32_t> triangles_touching(const TriangleTree& tree, const Bounds& box, std::size_t most)
{
    const auto meets = [&](const Eigen::Vector3d& low, const Eigen::Vector3d& high)
    { return (low.array() <= box.high.array()).all() && (high.array() >= box.low.array()).all(); };
    std::vector<std::int32_t> found, pending{0};
    while (!pending.empty() && found.size() < most)
    {
        const TriangleTree::Node& node = tree.nodes[static_cast<std::size_t>(pending.back())];
        pending.pop_back();
        if (!meets(node.low, node.high)) { continue; }
        if (node.count == 0)
        {
            pending.push_back(node.first);
            pending.push_back(node.first + 1);
        }
        for (std::int32_t i = node.first; i < node.first + node.count && found.size() < most; ++i)
        {
            const auto& [a, b, c] = tree.corners[static_cast<std::size_t>(i)];
            if (!meets(a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c))) { continue; }
            found.push_back(tree.triangles[static_cast<std::size_t>(i)]);
        }
    }
    return found;
}

} // namespace tread::shape
