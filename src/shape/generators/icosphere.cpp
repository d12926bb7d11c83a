#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "shape/generators/generators.hpp"

namespace tread::shape
{
namespace
{

TriangleMesh icosahedron()
{
    const double g = 0.5 * (1 + std::sqrt(5.0));
    TriangleMesh mesh{{{-1, g, 0},
                       {1, g, 0},
                       {-1, -g, 0},
                       {1, -g, 0},
                       {0, -1, g},
                       {0, 1, g},
                       {0, -1, -g},
                       {0, 1, -g},
                       {g, 0, -1},
                       {g, 0, 1},
                       {-g, 0, -1},
                       {-g, 0, 1}},
                      {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                       {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                       {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
    for (Eigen::Vector3d& vertex : mesh.vertices) { vertex.normalize(); }
    return mesh;
}

TriangleMesh quartered(const TriangleMesh& mesh)
{
    TriangleMesh                                                  finer{mesh.vertices, {}};
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
    const auto                                                    middle = [&](std::int32_t a, std::int32_t b)
    {
        const auto next              = static_cast<std::int32_t>(finer.vertices.size());
        const auto [entry, inserted] = middles.try_emplace(std::minmax(a, b), next);
        if (inserted)
        {
            const Eigen::Vector3d sum =
                finer.vertices[static_cast<std::size_t>(a)] + finer.vertices[static_cast<std::size_t>(b)];
            finer.vertices.push_back(sum.normalized());
        }
        return entry->second;
    };
    for (const auto& [a, b, c] : mesh.triangles)
    {
        const std::int32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        for (const auto& part : {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
        {
            finer.triangles.push_back(part);
        }
    }
    return finer;
}

} // namespace

TriangleMesh icosphere(int nodes, const std::string& origin)
{
    constexpr std::size_t most = 10242;
    TriangleMesh          mesh = icosahedron();
    while (mesh.vertices.size() < static_cast<std::size_t>(std::max(nodes, 0)) && mesh.vertices.size() < most)
    {
        mesh = quartered(mesh);
    }
    if (mesh.vertices.size() != static_cast<std::size_t>(std::max(nodes, 0)))
    {
        throw InputError(fmt::format("{}: nodes = {}: accepted are 12, 42, 162, 642, 2562 and 10242", origin, nodes));
    }
    return mesh;
}

TriangleMesh sphere_mesh(const scene::SphereGenerator& generator, const std::string& origin)
{
    TriangleMesh mesh = icosphere(generator.nodes, origin);
    for (Eigen::Vector3d& vertex : mesh.vertices) { vertex *= 0.5; }
    return mesh;
}

} // namespace tread::shape
