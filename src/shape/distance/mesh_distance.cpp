#include "shape/distance/mesh_distance.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "shape/mesh/half_edges.hpp"
#include "shape/mesh/triangle.hpp"

namespace tread::shape
{
namespace
{

std::vector<Eigen::Vector3d> face_normals(const TriangleMesh& mesh)
{
    std::vector<Eigen::Vector3d> normals;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) { normals.push_back(area_vector(mesh, t).normalized()); }
    return normals;
}

std::vector<Eigen::Vector3d> vertex_normals(const TriangleMesh& mesh, const std::vector<Eigen::Vector3d>& faces)
{
    std::vector<Eigen::Vector3d> normals(mesh.vertices.size(), Eigen::Vector3d::Zero());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    {
        for (std::size_t c = 0; c < 3; ++c)
        {
            normals[static_cast<std::size_t>(mesh.triangles[t][c])] += angle_at(mesh, t, c) * faces[t];
        }
    }
    return normals;
}

} // namespace

MeshDistance prepare_distance(const TriangleMesh& mesh)
{
    const std::vector<Eigen::Vector3d> faces    = face_normals(mesh);
    const std::vector<Eigen::Vector3d> vertices = vertex_normals(mesh, faces);

    MeshDistance distance{SignRule::pseudonormal, build_tree(mesh), {}, {}};
    distance.pseudonormals.resize(mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    {
        distance.pseudonormals[t][0] = faces[t];
        for (std::size_t c = 0; c < 3; ++c)
        {
            distance.pseudonormals[t][4 + c] = vertices[static_cast<std::size_t>(mesh.triangles[t][c])];
        }
    }
    for_each_edge(sorted_half_edges(mesh),
                  [&](auto first, auto last)
                  {
                      Eigen::Vector3d normal = Eigen::Vector3d::Zero();
                      for (auto half = first; half != last; ++half)
                      {
                          normal += faces[static_cast<std::size_t>(half->triangle)];
                      }
                      for (auto half = first; half != last; ++half)
                      {
                          distance.pseudonormals[static_cast<std::size_t>(half->triangle)]
                                                [static_cast<std::size_t>(1 + half->side)] = normal;
                      }
                  });
    return distance;
}

MeshDistance prepare_distance(const TriangleMesh& surface, const TriangleMesh& parts)
{
    return {SignRule::winding_number, build_tree(surface), {}, build_winding_tree(parts)};
}

double signed_distance(const MeshDistance& distance, const Eigen::Vector3d& point, double within)
{
    ClosestPoint closest = closest_point(distance.tree, point, within);
    if (closest.triangle < 0) { closest = closest_point(distance.tree, point); }
    const double length = std::sqrt(closest.squared_distance);
    if (distance.sign == SignRule::winding_number)
    {
        return winding_number(distance.winding, point) > 0.5 ? -length : length;
    }
    const Eigen::Vector3d& pseudonormal =
        distance.pseudonormals[static_cast<std::size_t>(closest.triangle)][static_cast<std::size_t>(closest.feature)];
    return std::copysign(length, (point - closest.point).dot(pseudonormal));
}

} // namespace tread::shape
