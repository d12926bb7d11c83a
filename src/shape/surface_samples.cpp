#include "shape/surface_samples.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "shape/half_edges.hpp"
#include "shape/point_directory.hpp"
#include "shape/triangle.hpp"

namespace tread::shape
{
namespace
{

/// Number of sharp edges at each vertex.
std::vector<int> count_sharp_edges(const TriangleMesh& mesh)
{
    const double     sharp_cosine = std::cos(40.0 / 180.0 * 3.14159265358979323846);
    std::vector<int> counts(mesh.vertices.size(), 0);
    for_each_edge(sorted_half_edges(mesh),
                  [&](auto first, auto last)
                  {
                      const Eigen::Vector3d one =
                          area_vector(mesh, static_cast<std::size_t>(first->triangle)).normalized();
                      const Eigen::Vector3d other =
                          area_vector(mesh, static_cast<std::size_t>((last - 1)->triangle)).normalized();
                      if (one.dot(other) >= sharp_cosine) { return; }
                      ++counts[static_cast<std::size_t>(first->low)];
                      ++counts[static_cast<std::size_t>(first->high)];
                  });
    return counts;
}

std::vector<Sharpness> sharpness(const TriangleMesh& mesh)
{
    std::vector<Sharpness> kinds;
    for (const int edges : count_sharp_edges(mesh))
    {
        kinds.push_back(edges == 0 ? Sharpness::smooth : edges == 2 ? Sharpness::edge : Sharpness::corner);
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
