#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "backend/vector.hpp"
#include "kernels/dem/contact/body_field_kern.hpp"

// Analytic shapes as templates of bodies, for tests of body-body contact.
namespace tread::test
{

/// A shape at scale 1: signed distance on a grid over 120 % of the box, and surface nodes.
struct SolidShape
{
    double                      spacing = 0;
    Vec3<double>                origin  = Vec3<double>::Zero();
    std::array<std::int32_t, 3> nodes{};
    std::vector<float>          values;
    std::vector<std::int32_t>   slots; ///< of a grid in bricks, as the three below: see shape::SignedDistanceGrid
    std::vector<float>          corners;
    std::array<std::int32_t, 3> bricks{};
    double                      fine_reach = 0;
    double                      steepest   = std::numbers::sqrt3; ///< upper bound on the slope of the interpolant
    std::vector<Vec3<double>>   positions;
    std::vector<double>         areas;
    std::vector<Vec3<double>>   centres; ///< of parts of clusters
    std::vector<double>         radii;
    Vec3<double>                half              = Vec3<double>::Zero();
    double                      bounding_radius   = 0;
    double                      equivalent_radius = 0;
    double                      sphere_radius     = 0; ///< of an exact sphere
    bool                        concave           = false;
};

template<class Distance>
void sample_on_grid(SolidShape& shape, int cells, Distance distance)
{
    shape.spacing = 2.4 * shape.half.maxCoeff() / cells;
    for (std::size_t c = 0; c < 3; ++c)
    {
        const auto axis    = static_cast<Eigen::Index>(c);
        shape.nodes[c]     = static_cast<std::int32_t>(std::ceil(2.4 * shape.half[axis] / shape.spacing - 1e-9)) + 1;
        shape.origin[axis] = -0.5 * shape.spacing * (shape.nodes[c] - 1);
    }
    for (int k = 0; k < shape.nodes[2]; ++k)
    {
        for (int j = 0; j < shape.nodes[1]; ++j)
        {
            for (int i = 0; i < shape.nodes[0]; ++i)
            {
                const Vec3<double> x = shape.origin + shape.spacing * Vec3<double>(i, j, k);
                shape.values.push_back(static_cast<float>(distance(x)));
            }
        }
    }
}

/// Encloses the nodes of each part, in the given order, which must be spatially local.
inline void enclose_parts(SolidShape& shape)
{
    constexpr std::size_t size = dem::part_size;
    for (std::size_t first = 0; first < shape.positions.size(); first += size)
    {
        const std::size_t last   = std::min(first + size, shape.positions.size());
        Vec3<double>      centre = Vec3<double>::Zero();
        for (std::size_t i = first; i < last; ++i) { centre += shape.positions[i]; }
        centre /= static_cast<double>(last - first);
        double radius = 0;
        for (std::size_t i = first; i < last; ++i) { radius = std::max(radius, (shape.positions[i] - centre).norm()); }
        shape.centres.push_back(centre);
        shape.radii.push_back(radius);
    }
}

/// Vertices of the unit icosahedron subdivided `level` times, each with a third of the area of its triangles; the areas
/// are normalised to sum to 4 pi.
inline std::vector<std::pair<Vec3<double>, double>> icosphere_nodes(int level)
{
    using Triangle              = std::array<std::size_t, 3>;
    const double              g = std::numbers::phi;
    std::vector<Vec3<double>> v = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    std::vector<Triangle> faces = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                                   {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                                   {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    for (Vec3<double>& x : v) { x.normalize(); }
    for (int l = 0; l < level; ++l)
    {
        std::map<std::pair<std::size_t, std::size_t>, std::size_t> middles;
        const auto                                                 middle = [&](std::size_t a, std::size_t b)
        {
            const auto [at, fresh] = middles.try_emplace(std::minmax(a, b), v.size());
            if (fresh) { v.push_back((v[a] + v[b]).normalized()); }
            return at->second;
        };
        std::vector<Triangle> finer;
        for (const Triangle& f : faces)
        {
            const std::size_t a = middle(f[0], f[1]), b = middle(f[1], f[2]), c = middle(f[2], f[0]);
            for (const Triangle& part :
                 {Triangle{f[0], a, c}, Triangle{f[1], b, a}, Triangle{f[2], c, b}, Triangle{a, b, c}})
            {
                finer.push_back(part);
            }
        }
        faces = finer;
    }
    std::vector<std::pair<Vec3<double>, double>> found;
    for (const Vec3<double>& x : v) { found.emplace_back(x, 0.0); }
    double total = 0;
    for (const Triangle& f : faces)
    {
        const double area = 0.5 * (v[f[1]] - v[f[0]]).cross(v[f[2]] - v[f[0]]).norm();
        for (const std::size_t i : f) { found[i].second += area / 3; }
        total += area;
    }
    for (auto& node : found) { node.second *= 4 * std::numbers::pi / total; }
    return found;
}

/// A sphere of radius 1 m with 10 * 4^level + 2 nodes.
inline SolidShape unit_sphere(int level, int cells)
{
    SolidShape shape;
    shape.half            = Vec3<double>::Ones();
    shape.bounding_radius = shape.equivalent_radius = 1;
    sample_on_grid(shape, cells, [](const Vec3<double>& x) { return x.norm() - 1; });
    auto nodes = icosphere_nodes(level);
    std::sort(nodes.begin(), nodes.end(), [](const auto& a, const auto& b) { return a.first[2] < b.first[2]; });
    for (const auto& [position, area] : nodes)
    {
        shape.positions.push_back(position);
        shape.areas.push_back(area);
    }
    enclose_parts(shape);
    return shape;
}

/// An exact sphere of radius 1 m; its nodes are used only against other shapes.
inline SolidShape exact_sphere()
{
    SolidShape shape    = unit_sphere(1, 16);
    shape.sphere_radius = 1;
    return shape;
}

/// A box with a lattice of nodes on its faces, n intervals along each edge; nodes on corners and edges occur once.
inline SolidShape box_solid(const Vec3<double>& half, int n, int cells)
{
    SolidShape shape;
    shape.half              = half;
    shape.bounding_radius   = half.norm();
    shape.equivalent_radius = std::cbrt(8 * half.prod() * 0.75 / std::numbers::pi);
    sample_on_grid(shape, cells,
                   [=](const Vec3<double>& x)
                   {
                       const Vec3<double> q = x.cwiseAbs() - half;
                       return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
                   });
    const double area = 8 * (half[0] * half[1] + half[1] * half[2] + half[2] * half[0]);
    for (int k = 0; k <= n; ++k)
    {
        for (int j = 0; j <= n; ++j)
        {
            for (int i = 0; i <= n; ++i)
            {
                if (i % n != 0 && j % n != 0 && k % n != 0) { continue; }
                shape.positions.push_back(half.cwiseProduct(Vec3<double>(i, j, k) * (2.0 / n) - Vec3<double>::Ones()));
            }
        }
    }
    shape.areas.assign(shape.positions.size(), area / static_cast<double>(shape.positions.size()));
    enclose_parts(shape);
    return shape;
}

} // namespace tread::test
