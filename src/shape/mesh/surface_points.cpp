#include "shape/mesh/surface_points.hpp"

#include <cmath>

#include "shape/mesh/triangle.hpp"

namespace tread::shape
{
namespace
{

/// Point of a triangle: first + u (second - first) + v (third - first), u + v <= 1.
Eigen::Vector3d point_in(const TriangleMesh& mesh, std::size_t triangle, double u, double v)
{
    if (u + v > 1)
    {
        u = 1 - u;
        v = 1 - v;
    }
    const Eigen::Vector3d& a = corner(mesh, triangle, 0);
    return a + u * (corner(mesh, triangle, 1) - a) + v * (corner(mesh, triangle, 2) - a);
}

double fraction(double x) { return x - std::floor(x); }

} // namespace

std::vector<SurfacePoint> points_on(const TriangleMesh& mesh, std::size_t count)
{
    constexpr double          plastic = 1.32471795724474602596; // root of x^3 = x + 1
    const double              share   = surface_area(mesh) / static_cast<double>(count);
    std::vector<SurfacePoint> points;
    double                    covered = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    {
        const Eigen::Vector3d twice = area_vector(mesh, t);
        covered += 0.5 * twice.norm();
        while (points.size() < count && (static_cast<double>(points.size()) + 0.5) * share < covered)
        {
            const auto i = static_cast<double>(points.size() + 1);
            points.push_back({point_in(mesh, t, fraction(i / plastic), fraction(i / (plastic * plastic))),
                              twice.normalized(), static_cast<std::int32_t>(t)});
        }
    }
    return points;
}

} // namespace tread::shape
