#include "shape/distance/winding_number.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include <Eigen/Geometry>

namespace tread::shape
{
namespace
{

/// Sums over triangles; positions are relative to a nearby origin, so that shifting keeps precision.
struct Moments
{
    Eigen::Vector3d area   = Eigen::Vector3d::Zero();
    Eigen::Vector3d first  = Eigen::Vector3d::Zero(); ///< size times middle
    double          weight = 0;                       ///< size
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero(); ///< area vector times middle^T
};

Moments leaf_moments(const TriangleTree& tree, const TriangleTree::Node& leaf, const Eigen::Vector3d& origin)
{
    Moments sum;
    for (std::int32_t i = leaf.first; i < leaf.first + leaf.count; ++i)
    {
        const auto& [a, b, c]        = tree.corners[static_cast<std::size_t>(i)];
        const Eigen::Vector3d area   = 0.5 * (b - a).cross(c - a);
        const Eigen::Vector3d middle = (a + b + c) / 3 - origin;
        const double          size   = area.norm();
        sum.area += area;
        sum.first += size * middle;
        sum.weight += size;
        sum.moment += area * middle.transpose();
    }
    return sum;
}

Moments both(const Moments& one, const Moments& other)
{
    return {one.area + other.area, one.first + other.first, one.weight + other.weight, one.moment + other.moment};
}

Cluster cluster(const Moments& sum, const TriangleTree::Node& node, const Eigen::Vector3d& origin)
{
    const Eigen::Vector3d middle = 0.5 * (node.low + node.high) - origin;
    const Eigen::Vector3d centre = sum.weight > 0 ? Eigen::Vector3d(sum.first / sum.weight) : middle;
    const Eigen::Vector3d place  = origin + centre;
    return {sum.area, sum.moment - sum.area * centre.transpose(), place,
            (node.high - place).cwiseMax(place - node.low).norm()};
}

// The solid angle of a surface S seen from q is the integral of n . r / r^3, r = x - q. About a centre, with R from q
// to it, the first two terms of Taylor's series in x - centre are
//   A . R / R^3  +  tr(M) / R^3 - 3 R^T M R / R^5,  A = sum of area vectors, M = sum of area vector (middle - centre)^T
// (the integral of x over a triangle is its size times its middle). The next is of relative size (radius / R)^2.
double seen_from_afar(const Cluster& cluster, const Eigen::Vector3d& way, double squared)
{
    const double cubed = squared * std::sqrt(squared);
    const double outer = 3 * way.dot(cluster.moment * way) / squared;
    return (cluster.area.dot(way) + cluster.moment.trace() - outer) / (4 * std::numbers::pi * cubed);
}

constexpr double near = 4; ///< distance, in radii, within which the children are visited

} // namespace

double covered_part(const std::array<Eigen::Vector3d, 3>& corners, const Eigen::Vector3d& point)
{
    const Eigen::Vector3d a = corners[0] - point, b = corners[1] - point, c = corners[2] - point;
    const double          x = a.norm(), y = b.norm(), z = c.norm();
    const double          volume = a.dot(b.cross(c));
    if (volume == 0) { return 0; }
    return std::atan2(volume, x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y) / (2 * std::numbers::pi);
}

WindingTree build_winding_tree(const TriangleMesh& mesh)
{
    WindingTree           winding{build_tree(mesh), {}};
    const TriangleTree&   tree   = winding.tree;
    const Eigen::Vector3d origin = 0.5 * (tree.nodes[0].low + tree.nodes[0].high);
    std::vector<Moments>  moments(tree.nodes.size());
    winding.clusters.resize(tree.nodes.size());
    // Children are stored after their parents.
    for (std::size_t n = tree.nodes.size(); n-- > 0;)
    {
        const TriangleTree::Node& node = tree.nodes[n];
        const auto                left = static_cast<std::size_t>(node.first);
        moments[n] = node.count > 0 ? leaf_moments(tree, node, origin) : both(moments[left], moments[left + 1]);
        winding.clusters[n] = cluster(moments[n], node, origin);
    }
    return winding;
}

double winding_number(const WindingTree& winding, const Eigen::Vector3d& point)
{
    const TriangleTree&          tree = winding.tree;
    std::array<std::int32_t, 64> stack; // as deep as that of closest_point
    std::size_t                  top = 0;
    double                       sum = 0;
    stack[top++]                     = 0;
    while (top > 0)
    {
        const auto                at      = static_cast<std::size_t>(stack[--top]);
        const TriangleTree::Node& node    = tree.nodes[at];
        const Cluster&            cluster = winding.clusters[at];
        const Eigen::Vector3d     way     = cluster.centre - point;
        const double              squared = way.squaredNorm();
        if (squared > near * near * cluster.radius * cluster.radius)
        {
            sum += seen_from_afar(cluster, way, squared);
            continue;
        }
        if (node.count == 0)
        {
            stack[top++] = node.first;
            stack[top++] = node.first + 1;
        }
        for (std::int32_t i = node.first; i < node.first + node.count; ++i)
        {
            sum += covered_part(tree.corners[static_cast<std::size_t>(i)], point);
        }
    }
    return sum;
}

double winding_number_on(const WindingTree& winding, const std::array<Eigen::Vector3d, 3>& triangle, double step)
{
    const auto& [a, b, c]        = triangle;
    const Eigen::Vector3d middle = (a + b + c) / 3;
    const Eigen::Vector3d way    = step * (b - a).cross(c - a).normalized();
    return 0.5 * (winding_number(winding, middle + way) + winding_number(winding, middle - way));
}

} // namespace tread::shape
