#include "shape/distance/sdf_report.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <Eigen/Geometry>

#include "shape/mesh/surface_points.hpp"

namespace tread::shape
{
namespace
{

constexpr double degrees = 180 / 3.14159265358979323846;

/// Points at which a field should vanish. For a generated sphere they lie on the exact sphere, not on its facets.
std::vector<SurfacePoint> surface_of(const TemplateDistance& distance, const TriangleMesh& mesh)
{
    constexpr std::size_t     count  = 20000;
    std::vector<SurfacePoint> points = points_on(mesh, count);
    if (distance.mesh != nullptr) { return points; }
    for (SurfacePoint& point : points)
    {
        point.normal   = point.position.normalized();
        point.position = 0.5 * point.normal;
    }
    return points;
}

void measure(const SignedDistanceGrid& sdf, const std::vector<SurfacePoint>& points, double extent, SdfQuality& quality)
{
    const auto count = static_cast<double>(points.size());
    for (const SurfacePoint& point : points)
    {
        const double          error    = std::abs(sample(sdf, point.position)) / extent;
        const Eigen::Vector3d gradient = sample_gradient(sdf, point.position);
        const double angle = degrees * std::atan2(gradient.cross(point.normal).norm(), gradient.dot(point.normal));
        quality.mean_surface += error / count;
        quality.mean_normal += angle / count;
        quality.worst_surface = std::max(quality.worst_surface, error);
        quality.worst_normal  = std::max(quality.worst_normal, angle);
    }
}

} // namespace

std::vector<int> report_cells() { return {10, 15, 20, 30, 40, 60, 80, 100, 150, 200}; }

std::vector<SdfQuality> sdf_convergence(const MeasuredTemplate& measured, const std::vector<int>& cells)
{
    using Clock                  = std::chrono::steady_clock;
    const auto& [form, distance] = measured;
    const auto   points          = surface_of(distance, form.mesh);
    const double extent          = form.box.extent().maxCoeff();

    std::vector<SdfQuality> qualities;
    for (const int n : cells)
    {
        const auto               start = Clock::now();
        const SignedDistanceGrid sdf   = build_sdf(form.box, n, distance.function);
        SdfQuality               quality{};
        quality.seconds      = std::chrono::duration<double>(Clock::now() - start).count();
        quality.cells        = n;
        quality.bytes        = sdf.bytes();
        quality.volume_ratio = enclosed_volume(sdf) / form.unit.volume;
        measure(sdf, points, extent, quality);
        qualities.push_back(quality);
    }
    return qualities;
}

} // namespace tread::shape
