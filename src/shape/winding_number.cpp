#include "shape/winding_number.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>

#include <Eigen/Geometry>

namespace tread::shape
{
namespace
{

constexpr double pi = 3.14159265358979323846;

/// Sums over triangles, from which a dipole is made.
struct Moments
{
    Eigen::Vector3d area   = Eigen::Vector3d::Zero();
    Eigen::Vector3d first  = Eigen::Vector3d::Zero(); ///< area times middle
    double          weight = 0;                       ///< area
};

Moments leaf_moments(const TriangleTree& tree, const TriangleTree::Node& leaf)
{
    Moments sum;
    for (std::int32_t i = leaf.first; i < leaf.first + leaf.count; ++i)
    {
        const auto& [a, b, c]      = tree.corners[static_cast<std::size_t>(i)];
        const Eigen::Vector3d area = 0.5 * (b - a).cross(c - a);
        const double          size = area.norm();
        sum.area += area;
        sum.first += size / 3 * (a + b + c);
        sum.weight += size;
    }
    return sum;
}

Dipole dipole(const Moments& sum, const TriangleTree::Node& node)
{
    const Eigen::Vector3d middle = 0.5 * (node.low + node.high);
    const Eigen::Vector3d centre = sum.weight > 0 ? Eigen::Vector3d(sum.first / sum.weight) : middle;
    return {sum.area, centre, (node.high - centre).cwiseMax(centre - node.low).norm()};
}

// The solid angle of a surface S seen from q is the integral of n . (x - q) / |x - q|^3. Expanded about a centre p, the
// zeroth term is A . (p - q) / |p - q|^3 with A the sum of the area vectors; the next is of relative size
// radius / |p - q|, and the choice of p takes its larger part away.
double seen_as_dipole(const Dipole& dipole, const Eigen::Vector3d& way, double squared)
{
    return dipole.area.dot(way) / (4 * pi * squared * std::sqrt(squared));
}

constexpr double near = 4; ///< radii within which the children are asked

} // namespace

double covered_part(const std::array<Eigen::Vector3d, 3>& corners, const Eigen::Vector3d& point)
{
    const Eigen::Vector3d a = corners[0] - point, b = corners[1] - point, c = corners[2] - point;
    const double          x = a.norm(), y = b.norm(), z = c.norm();
    const double          volume = a.dot(b.cross(c));
    if (volume == 0) { return 0; }
    return std::atan2(volume, x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y) / (2 * pi);
}

WindingTree build_winding_tree(const TriangleMesh& mesh)
{
    WindingTree          winding{build_tree(mesh), {}};
    const TriangleTree&  tree = winding.tree;
    std::vector<Moments> moments(tree.nodes.size());
    winding.dipoles.resize(tree.nodes.size());
    // Children stand behind their parents.
    for (std::size_t n = tree.nodes.size(); n-- > 0;)
    {
        const TriangleTree::Node& node = tree.nodes[n];
        if (node.count > 0) { moments[n] = leaf_moments(tree, node); }
        else
        {
            const auto     left = static_cast<std::size_t>(node.first);
            const Moments &one = moments[left], &other = moments[left + 1];
            moments[n] = {one.area + other.area, one.first + other.first, one.weight + other.weight};
        }
        winding.dipoles[n] = dipole(moments[n], node);
    }
    return winding;
}

double winding_number(const WindingTree& winding, const Eigen::Vector3d& point)
{
    const TriangleTree&          tree = winding.tree;
    std::array<std::int32_t, 64> stack; // as deep as closest_point's
    std::size_t                  top = 0;
    double                       sum = 0;
    stack[top++]                     = 0;
    while (top > 0)
    {
        const auto                at      = static_cast<std::size_t>(stack[--top]);
        const TriangleTree::Node& node    = tree.nodes[at];
        const Dipole&             dipole  = winding.dipoles[at];
        const Eigen::Vector3d     way     = dipole.centre - point;
        const double              squared = way.squaredNorm();
        if (squared > near * near * dipole.radius * dipole.radius)
        {
            sum += seen_as_dipole(dipole, way, squared);
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
