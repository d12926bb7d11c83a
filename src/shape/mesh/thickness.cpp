#include "shape/mesh/thickness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "shape/mesh/surface_points.hpp"
#include "shape/mesh/triangle.hpp"

namespace tread::shape
{
namespace
{

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Distance (m) along the ray to a box; infinite if it misses.
double entry(const TriangleTree::Node& node, const Eigen::Vector3d& origin, const Eigen::Vector3d& inverse)
{
    const Eigen::Vector3d at_low  = (node.low - origin).cwiseProduct(inverse);
    const Eigen::Vector3d at_high = (node.high - origin).cwiseProduct(inverse);
    const double          in      = std::max(at_low.cwiseMin(at_high).maxCoeff(), 0.0);
    return in <= at_low.cwiseMax(at_high).minCoeff() ? in : infinity;
}

/// Distance (m) along the ray to a triangle; infinite if it misses.
double crossing(const std::array<Eigen::Vector3d, 3>& corners, const Eigen::Vector3d& origin,
                const Eigen::Vector3d& direction)
{
    const Eigen::Vector3d ab = corners[1] - corners[0], ac = corners[2] - corners[0];
    const Eigen::Vector3d p           = direction.cross(ac);
    const double          determinant = ab.dot(p);
    if (determinant == 0) { return infinity; }
    const Eigen::Vector3d from = origin - corners[0];
    const double          b    = from.dot(p) / determinant;
    const Eigen::Vector3d q    = from.cross(ab);
    const double          c    = direction.dot(q) / determinant;
    const double          t    = ac.dot(q) / determinant;
    return b >= 0 && c >= 0 && b + c <= 1 && t > 0 ? t : infinity;
}

/// A zero component would make the box test compute 0 * infinity on a box's face.
Eigen::Vector3d inverse_of(const Eigen::Vector3d& direction)
{
    constexpr double least = 1e-200;
    return direction.unaryExpr([](double d) { return 1 / (std::abs(d) < least ? std::copysign(least, d) : d); });
}

} // namespace

RayHit first_hit(const TriangleTree& tree, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                 std::int32_t but)
{
    const Eigen::Vector3d        inverse = inverse_of(direction);
    RayHit                       hit{infinity, -1};
    std::array<std::int32_t, 64> stack; // as deep as that of closest_point
    std::size_t                  top = 0;
    stack[top++]                     = 0;
    while (top > 0)
    {
        const TriangleTree::Node& node = tree.nodes[static_cast<std::size_t>(stack[--top])];
        if (!(entry(node, origin, inverse) < hit.distance)) { continue; }
        if (node.count == 0)
        {
            stack[top++] = node.first;
            stack[top++] = node.first + 1;
            continue;
        }
        for (auto i = static_cast<std::size_t>(node.first); i < static_cast<std::size_t>(node.first + node.count); ++i)
        {
            const double distance = tree.triangles[i] == but ? infinity : crossing(tree.corners[i], origin, direction);
            if (distance < hit.distance) { hit = {distance, tree.triangles[i]}; }
        }
    }
    return hit;
}

double thinnest_wall(const TriangleMesh& mesh, const TriangleTree& tree)
{
    constexpr std::size_t samples = 8192, may_be_thinner = samples / 50;
    const double          least_parallel = std::sqrt(0.5);
    const auto            points         = points_on(mesh, samples);
    std::vector<double>   chords(points.size(), infinity);
#pragma omp parallel for schedule(dynamic, 64)
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        const Eigen::Vector3d inward = -points[i].normal;
        const RayHit          hit    = first_hit(tree, points[i].position, inward, points[i].triangle);
        if (hit.triangle < 0) { continue; }
        const Eigen::Vector3d out = area_vector(mesh, static_cast<std::size_t>(hit.triangle)).normalized();
        if (out.dot(inward) >= least_parallel) { chords[i] = hit.distance; }
    }
    const auto middle = chords.begin() + static_cast<std::ptrdiff_t>(may_be_thinner);
    std::nth_element(chords.begin(), middle, chords.end());
    return *middle;
}

} // namespace tread::shape
