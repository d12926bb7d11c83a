#include "shape/flat_tree.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace tread::shape
{
namespace
{

struct Flattener
{
    const TriangleTree& tree;
    double              margin;
    FlatTree&           flat;

    static float below(double value) { return std::nextafter(static_cast<float>(value), -huge); }
    static float above(double value) { return std::nextafter(static_cast<float>(value), huge); }

    void append(std::size_t at)
    {
        const TriangleTree::Node& node = tree.nodes[at];
        FlatTree::Box             box{};
        for (std::size_t c = 0; c < 3; ++c)
        {
            const auto axis = static_cast<Eigen::Index>(c);
            box.low[c]      = below(node.low[axis] - margin);
            box.high[c]     = above(node.high[axis] + margin);
        }
        box.leaf               = node.count > 0 ? 8 * node.first + node.count : 0;
        const std::size_t self = flat.boxes.size();
        flat.boxes.push_back(box);
        if (node.count == 0)
        {
            append(static_cast<std::size_t>(node.first));
            append(static_cast<std::size_t>(node.first) + 1);
        }
        flat.boxes[self].next = static_cast<std::int32_t>(flat.boxes.size());
    }

private:
    static constexpr float huge = std::numeric_limits<float>::max();
};

double distance_to_segment(const Eigen::Vector3d& point, const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
    const Eigen::Vector3d along = b - a;
    const double          part  = std::clamp((point - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (point - a - part * along).norm();
}

/// Angle of the part of a small circle about `point`, on the triangle, that lies within the triangle. A point within
/// `tolerance` (m) of a side or a corner counts as on it.
double angle_about(const Corners& corners, const Eigen::Vector3d& point, double tolerance)
{
    for (std::size_t c = 0; c < 3; ++c)
    {
        if ((point - corners[c]).norm() > tolerance) { continue; }
        const Eigen::Vector3d left = corners[(c + 1) % 3] - corners[c], right = corners[(c + 2) % 3] - corners[c];
        return std::atan2(left.cross(right).norm(), left.dot(right));
    }
    for (std::size_t c = 0; c < 3; ++c)
    {
        if (distance_to_segment(point, corners[c], corners[(c + 1) % 3]) <= tolerance) { return std::numbers::pi; }
    }
    return 2 * std::numbers::pi;
}

/// Whether a point within `tolerance` of the triangle's box is within about that distance of the triangle.
bool holds(const Corners& corners, const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double tolerance)
{
    if (std::abs(normal.dot(point - corners[0])) > tolerance) { return false; }
    for (std::size_t c = 0; c < 3; ++c)
    {
        const Eigen::Vector3d side = corners[(c + 1) % 3] - corners[c];
        if (normal.cross(side).normalized().dot(point - corners[c]) < -tolerance) { return false; }
    }
    return true;
}

Eigen::Vector3d normal_at(const TriangleMesh& mesh, const TriangleTree& tree, const ClosestPoint& place,
                          double tolerance)
{
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(tolerance);
    const Eigen::Vector3d face  = area_vector(mesh, static_cast<std::size_t>(place.triangle)).normalized();
    Eigen::Vector3d       sum   = Eigen::Vector3d::Zero();
    for (const std::int32_t triangle :
         triangles_touching(tree, {place.point - reach, place.point + reach}, tree.triangles.size()))
    {
        const auto            t      = static_cast<std::size_t>(triangle);
        const Corners         around = corners(mesh, t);
        const Eigen::Vector3d normal = area_vector(mesh, t).normalized();
        if (holds(around, place.point, normal, tolerance))
        {
            sum += angle_about(around, place.point, tolerance) * normal;
        }
    }
    // The two sides of a wall without thickness cancel.
    return sum.norm() > 1e-6 ? sum.normalized() : face;
}

} // namespace

FlatTree flatten(const TriangleTree& tree)
{
    constexpr double margin = 1e-6; // of the extent
    FlatTree         flat;
    flat.triangles = tree.corners;
    flat.boxes.reserve(tree.nodes.size());
    Flattener{tree, margin * (tree.nodes[0].high - tree.nodes[0].low).maxCoeff(), flat}.append(0);
    return flat;
}

std::vector<Eigen::Vector3d> surface_normals(const TriangleMesh& mesh, const TriangleTree& tree,
                                             const std::vector<Eigen::Vector3d>& points)
{
    const double                 tolerance = 1e-7 * (tree.nodes[0].high - tree.nodes[0].low).maxCoeff();
    std::vector<Eigen::Vector3d> normals;
    normals.reserve(points.size());
    for (const Eigen::Vector3d& point : points)
    {
        normals.push_back(normal_at(mesh, tree, closest_point(tree, point), tolerance));
    }
    return normals;
}

} // namespace tread::shape
