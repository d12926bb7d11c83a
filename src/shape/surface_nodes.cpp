#include "shape/surface_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "shape/mesh/refinement.hpp"
#include "shape/mesh/triangle.hpp"
#include "shape/node_places.hpp"
#include "shape/surface_samples.hpp"

namespace tread::shape
{
namespace
{

/// Splits a range of nodes across its longest extent, at a multiple of the cluster size until each piece is one
/// cluster, and at a multiple of the part size until each is a part: more compact than along a space-filling curve.
void split_into_parts(const std::vector<Eigen::Vector3d>& positions, std::vector<std::size_t>::iterator first,
                      std::vector<std::size_t>::iterator last)
{
    const auto size = last - first > SurfaceNodes::cluster_size ? SurfaceNodes::cluster_size : SurfaceNodes::part_size;
    const auto pieces = (last - first + size - 1) / size;
    if (pieces <= 1)
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
    const auto middle = first + pieces / 2 * size;
    std::nth_element(first, middle, last,
                     [&](std::size_t one, std::size_t other)
                     { return std::pair(positions[one][axis], one) < std::pair(positions[other][axis], other); });
    split_into_parts(positions, first, middle);
    split_into_parts(positions, middle, last);
}

void enclose_part(SurfaceNodes& nodes, std::size_t first, std::size_t last)
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
    nodes.part_centres.push_back(centre);
    nodes.part_radii.push_back(radius);
}

/// Orders the nodes into clusters and their parts, and computes the bounding sphere of each part.
SurfaceNodes order_nodes(const std::vector<Eigen::Vector3d>& positions, const std::vector<double>& areas)
{
    std::vector<std::size_t> order(positions.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    split_into_parts(positions, order.begin(), order.end());

    SurfaceNodes nodes;
    double       area = 0;
    for (const std::size_t at : order)
    {
        nodes.positions.push_back(positions[at]);
        nodes.areas.push_back(areas[at]);
        area += areas[at];
    }
    nodes.spacing = std::sqrt(area / static_cast<double>(order.size()));
    for (std::size_t first = 0; first < order.size(); first += SurfaceNodes::part_size)
    {
        enclose_part(nodes, first, std::min(first + SurfaceNodes::part_size, order.size()));
    }
    return nodes;
}

} // namespace

SurfaceNodes nodes_at_vertices(const TriangleMesh& mesh) { return order_nodes(mesh.vertices, vertex_areas(mesh)); }

SurfaceNodes resample_to_count(const TriangleMesh& mesh, int count)
{
    // Relative to the spacing.
    constexpr double apart = 0.2, longest = 0.5;

    const double                   spacing = std::sqrt(surface_area(mesh) / count);
    const SurfaceSamples           samples = surface_samples(refined(mesh, longest * spacing), apart * spacing);
    const std::vector<std::size_t> places  = evened(samples, spread(samples, static_cast<std::size_t>(count)));
    const std::vector<std::size_t> owners  = nearest_places(samples, places);

    std::vector<Eigen::Vector3d> positions;
    std::vector<double>          areas(places.size(), 0.0);
    positions.reserve(places.size());
    for (const std::size_t place : places) { positions.push_back(samples.positions[place]); }
    for (std::size_t i = 0; i < owners.size(); ++i) { areas[owners[i]] += samples.areas[i]; }
    return order_nodes(positions, areas);
}

SurfaceNodes resample(const TriangleMesh& mesh, double spacing)
{
    constexpr double most  = 1e6;
    const double     nodes = surface_area(mesh) / (spacing * spacing);
    if (nodes > most)
    {
        throw InputError(
            fmt::format("surface nodes {:.3g} m apart are {:.3g}; accepted: at most {:.0f}, {:.3g} m apart", spacing,
                        nodes, most, std::sqrt(surface_area(mesh) / most)));
    }
    return resample_to_count(mesh, std::max(1, static_cast<int>(std::lround(nodes))));
}

} // namespace tread::shape
