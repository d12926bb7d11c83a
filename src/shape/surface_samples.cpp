#include "shape/surface_samples.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "shape/mesh/half_edges.hpp"
#include "shape/mesh/point_directory.hpp"
#include "shape/mesh/triangle.hpp"

namespace tread::shape
{
namespace
{

/// Edges at each vertex.
struct EdgeCounts
{
    std::vector<int> sharp;
    std::vector<int> unpaired; ///< with other than two triangles, as along seams of different refinement
};

EdgeCounts count_edges(const TriangleMesh& mesh)
{
    const double sharp_cosine = std::cos(40.0 / 180.0 * 3.14159265358979323846);
    EdgeCounts   counts{std::vector<int>(mesh.vertices.size(), 0), std::vector<int>(mesh.vertices.size(), 0)};
    const auto   count = [](std::vector<int>& of, const auto& half)
    {
        ++of[static_cast<std::size_t>(half->low)];
        ++of[static_cast<std::size_t>(half->high)];
    };
    for_each_edge(sorted_half_edges(mesh),
                  [&](auto first, auto last)
                  {
                      const Eigen::Vector3d one =
                          area_vector(mesh, static_cast<std::size_t>(first->triangle)).normalized();
                      const Eigen::Vector3d other =
                          area_vector(mesh, static_cast<std::size_t>((last - 1)->triangle)).normalized();
                      if (last - first != 2) { count(counts.unpaired, first); }
                      if (one.dot(other) < sharp_cosine) { count(counts.sharp, first); }
                  });
    return counts;
}

/// Sum (rad) of the angles of the triangles at each vertex: 2 pi on a smooth surface, less at a tip.
std::vector<double> sum_angles(const TriangleMesh& mesh)
{
    std::vector<double> sums(mesh.vertices.size(), 0.0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    {
        for (std::size_t c = 0; c < 3; ++c)
        {
            sums[static_cast<std::size_t>(mesh.triangles[t][c])] += angle_at(mesh, t, c);
        }
    }
    return sums;
}

std::vector<Sharpness> sharpness(const TriangleMesh& mesh)
{
    constexpr double          tip    = 1.05 * 3.14159265358979323846; ///< rad: a cone with an apex angle of 63 degrees
    const EdgeCounts          edges  = count_edges(mesh);
    const std::vector<double> angles = sum_angles(mesh);
    std::vector<Sharpness>    kinds;
    for (std::size_t v = 0; v < angles.size(); ++v)
    {
        const int  sharp   = edges.sharp[v];
        const bool pointed = sharp == 0 && edges.unpaired[v] == 0 && angles[v] < tip;
        const bool corner  = sharp == 1 || sharp > 2 || pointed;
        kinds.push_back(corner ? Sharpness::corner : sharp == 2 ? Sharpness::edge : Sharpness::smooth);
    }
    return kinds;
}

std::vector<std::size_t> by_sharpness(const std::vector<Sharpness>& kinds)
{
    std::vector<std::size_t> order(kinds.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return kinds[a] < kinds[b]; });
    return order;
}

std::vector<Eigen::Vector3d> vertex_normals(const TriangleMesh& mesh)
{
    std::vector<Eigen::Vector3d> normals(mesh.vertices.size(), Eigen::Vector3d::Zero());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    {
        for (const std::int32_t v : mesh.triangles[t]) { normals[static_cast<std::size_t>(v)] += area_vector(mesh, t); }
    }
    for (Eigen::Vector3d& normal : normals) { normal.normalize(); }
    return normals;
}

} // namespace

std::vector<double> vertex_areas(const TriangleMesh& mesh)
{
    std::vector<double> areas(mesh.vertices.size(), 0.0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    {
        const double third = area_vector(mesh, t).norm() / 6;
        for (const std::int32_t v : mesh.triangles[t]) { areas[static_cast<std::size_t>(v)] += third; }
    }
    return areas;
}

SurfaceSamples surface_samples(const TriangleMesh& mesh, double apart)
{
    const std::vector<Eigen::Vector3d> normals = vertex_normals(mesh);
    const std::vector<double>          areas   = vertex_areas(mesh);
    const std::vector<Sharpness>       kinds   = sharpness(mesh);

    SurfaceSamples samples;
    PointDirectory kept(apart);
    for (const std::size_t v : by_sharpness(kinds))
    {
        if (kept.nearest(mesh.vertices[v], normals[v])) { continue; }
        kept.add(mesh.vertices[v], normals[v]);
        samples.positions.push_back(mesh.vertices[v]);
        samples.normals.push_back(normals[v]);
        samples.kinds.push_back(kinds[v]);
    }
    samples.areas.resize(samples.positions.size(), 0.0);
    for (std::size_t v = 0; v < areas.size(); ++v)
    {
        samples.areas[kept.nearest(mesh.vertices[v], normals[v]).value()] += areas[v];
    }
    return samples;
}

} // namespace tread::shape
