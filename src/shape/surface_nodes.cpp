#include "shape/surface_nodes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "shape/half_edges.hpp"
#include "shape/triangle.hpp"

namespace tread::shape
{
namespace
{

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

/// Halves a range of nodes across its longest extent, at a whole number of clusters, until each is one cluster: rounder
/// runs than along a space-filling curve.
void split_into_clusters(const std::vector<Eigen::Vector3d>& positions, std::vector<std::size_t>::iterator first,
                         std::vector<std::size_t>::iterator last)
{
    const auto clusters = (last - first + SurfaceNodes::cluster_size - 1) / SurfaceNodes::cluster_size;
    if (clusters <= 1)
    {
        std::sort(first, last);
        return;
    }
    Eigen::Vector3d low = positions[*first], high = low;
    for (auto at = first; at != last; ++at)
    {
        low  = low.cwiseMin(positions[*at]);
        high = high.cwiseMax(positions[*at]);
    }
    Eigen::Index axis;
    (high - low).maxCoeff(&axis);
    const auto middle = first + clusters / 2 * SurfaceNodes::cluster_size;
    std::nth_element(first, middle, last,
                     [&](std::size_t one, std::size_t other)
                     { return std::pair(positions[one][axis], one) < std::pair(positions[other][axis], other); });
    split_into_clusters(positions, first, middle);
    split_into_clusters(positions, middle, last);
}

void enclose_cluster(SurfaceNodes& nodes, std::size_t first, std::size_t last)
{
    Eigen::Vector3d low = nodes.positions[first], high = low;
    for (std::size_t i = first; i < last; ++i)
    {
        low  = low.cwiseMin(nodes.positions[i]);
        high = high.cwiseMax(nodes.positions[i]);
    }
    const Eigen::Vector3d centre = 0.5 * (low + high);
    double                radius = 0;
    for (std::size_t i = first; i < last; ++i) { radius = std::max(radius, (nodes.positions[i] - centre).norm()); }
    nodes.cluster_centres.push_back(centre);
    nodes.cluster_radii.push_back(radius);
}

/// Orders the nodes into clusters and encloses each.
SurfaceNodes cluster(const std::vector<Eigen::Vector3d>& positions, const std::vector<double>& areas)
{
    std::vector<std::size_t> order(positions.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    split_into_clusters(positions, order.begin(), order.end());

    SurfaceNodes nodes;
    double       area = 0;
    for (const std::size_t at : order)
    {
        nodes.positions.push_back(positions[at]);
        nodes.areas.push_back(areas[at]);
        area += areas[at];
    }
    nodes.spacing = std::sqrt(area / static_cast<double>(order.size()));
    for (std::size_t first = 0; first < order.size(); first += SurfaceNodes::cluster_size)
    {
        enclose_cluster(nodes, first, std::min(first + SurfaceNodes::cluster_size, order.size()));
    }
    return nodes;
}

/// Halves the longest side of each triangle until none is longer than `longest`. Every side that is too long is halved
/// in both its triangles, in whatever order, so that the mesh stays closed without their knowing of each other.
class Refinement
{
public:
    Refinement(const TriangleMesh& mesh, double longest)
        : refined{mesh.vertices, {}}
        , longest_squared_(longest * longest)
    {
        for (const auto& triangle : mesh.triangles) { refine(triangle); }
    }

    TriangleMesh refined;

private:
    double squared_length(std::int32_t a, std::int32_t b) const
    {
        return (refined.vertices[static_cast<std::size_t>(a)] - refined.vertices[static_cast<std::size_t>(b)])
            .squaredNorm();
    }

    static std::uint64_t edge_key(std::int32_t a, std::int32_t b)
    {
        return static_cast<std::uint64_t>(std::min(a, b)) << 32 | static_cast<std::uint64_t>(std::max(a, b));
    }

    std::int32_t middle(std::int32_t a, std::int32_t b)
    {
        const auto next              = static_cast<std::int32_t>(refined.vertices.size());
        const auto [entry, inserted] = middles_.try_emplace(edge_key(a, b), next);
        if (inserted)
        {
            const Eigen::Vector3d place =
                0.5 * (refined.vertices[static_cast<std::size_t>(a)] + refined.vertices[static_cast<std::size_t>(b)]);
            refined.vertices.push_back(place);
        }
        return entry->second;
    }

    void refine(const std::array<std::int32_t, 3>& triangle)
    {
        std::size_t side   = 0;
        double      length = 0;
        for (std::size_t s = 0; s < 3; ++s)
        {
            const double squared = squared_length(triangle[s], triangle[(s + 1) % 3]);
            if (squared > length)
            {
                length = squared;
                side   = s;
            }
        }
        if (length <= longest_squared_)
        {
            refined.triangles.push_back(triangle);
            return;
        }
        const std::int32_t from = triangle[side], to = triangle[(side + 1) % 3], apex = triangle[(side + 2) % 3];
        const std::int32_t half = middle(from, to);
        refine({from, half, apex});
        refine({half, to, apex});
    }

    double                                          longest_squared_;
    std::unordered_map<std::uint64_t, std::int32_t> middles_;
};

/// How many sharp edges meet at each vertex.
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

/// Corners (where other than two sharp edges meet) first, then points of sharp edges, then the rest; by index within.
std::vector<std::size_t> by_sharpness(const std::vector<int>& sharp_edges)
{
    const auto rank = [&](std::size_t vertex)
    {
        const int sharp = sharp_edges[vertex];
        return sharp == 0 ? 2 : sharp == 2 ? 1 : 0;
    };
    std::vector<std::size_t> order(sharp_edges.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
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

/// Points with normals, found again by place.
class Thinned
{
public:
    explicit Thinned(double radius)
        : squared_radius_(radius * radius)
        , cell_(2 * radius)
    {
    }

    void add(const Eigen::Vector3d& position, const Eigen::Vector3d& normal)
    {
        cells_[key(cell_of(position))].push_back(positions.size());
        positions.push_back(position);
        normals_.push_back(normal);
    }

    /// The nearest point within the radius on the same side of the body; none if the two face away from each other.
    std::optional<std::size_t> nearest(const Eigen::Vector3d& position, const Eigen::Vector3d& normal) const
    {
        std::optional<std::size_t> best;
        double                     least = squared_radius_;
        const Cell                 low   = cell_of(position - Eigen::Vector3d::Constant(0.5 * cell_));
        for (int c = 0; c < 8; ++c)
        {
            const auto found = cells_.find(key(low + Cell(c & 1, (c >> 1) & 1, c >> 2)));
            if (found == cells_.end()) { continue; }
            for (const std::size_t at : found->second)
            {
                const double squared = (positions[at] - position).squaredNorm();
                if (squared >= least || normals_[at].dot(normal) < facing_away) { continue; }
                least = squared;
                best  = at;
            }
        }
        return best;
    }

    std::vector<Eigen::Vector3d> positions;

private:
    using Cell = Eigen::Matrix<std::int64_t, 3, 1>;

    // Beyond 120 degrees: across a thin wall, not around an edge of it.
    static constexpr double facing_away = -0.5;

    Cell cell_of(const Eigen::Vector3d& position) const
    {
        return (position / cell_).array().floor().cast<std::int64_t>();
    }

    static std::uint64_t key(const Cell& cell)
    {
        constexpr std::int64_t half = 1 << 20; // cells to either side of the origin
        const auto low = [&](std::int64_t c) { return static_cast<std::uint64_t>(c + half) & (2 * half - 1); };
        return low(cell.x()) | low(cell.y()) << 21 | low(cell.z()) << 42;
    }

    double                                                      squared_radius_;
    double                                                      cell_;
    std::vector<Eigen::Vector3d>                                normals_;
    std::unordered_map<std::uint64_t, std::vector<std::size_t>> cells_;
};

/// Keeps vertices at least `radius` apart, each with the areas of all vertices that are nearest to it.
SurfaceNodes thin(const TriangleMesh& mesh, double radius)
{
    const std::vector<Eigen::Vector3d> normals = vertex_normals(mesh);
    const std::vector<double>          areas   = vertex_areas(mesh);
    Thinned                            kept(radius);
    for (const std::size_t v : by_sharpness(count_sharp_edges(mesh)))
    {
        if (!kept.nearest(mesh.vertices[v], normals[v])) { kept.add(mesh.vertices[v], normals[v]); }
    }
    std::vector<double> gathered(kept.positions.size(), 0.0);
    for (std::size_t v = 0; v < areas.size(); ++v)
    {
        gathered[kept.nearest(mesh.vertices[v], normals[v]).value()] += areas[v];
    }
    return cluster(kept.positions, gathered);
}

} // namespace

SurfaceNodes nodes_at_vertices(const TriangleMesh& mesh) { return cluster(mesh.vertices, vertex_areas(mesh)); }

SurfaceNodes resample(const TriangleMesh& mesh, double spacing)
{
    // By measurement: nodes come out 0.87 to 1.2 of `spacing` apart (sqrt(area / count)) on balls, wheels and boxes.
    constexpr double edge_factor = 0.5, radius_factor = 0.85;

    const Refinement refinement(mesh, edge_factor * spacing);
    return thin(refinement.refined, radius_factor * spacing);
}

} // namespace tread::shape
