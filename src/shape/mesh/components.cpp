#include "shape/mesh/components.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/random.hpp"
#include "shape/mesh/half_edges.hpp"
#include "shape/mesh/triangle.hpp"

namespace tread::shape
{
namespace
{

/// A neighbouring triangle across an edge that two triangles share.
struct Neighbour
{
    std::int32_t triangle = -1;
    bool         opposed  = false; ///< both traverse the edge in the same direction
};

using Neighbours = std::vector<std::array<Neighbour, 3>>;

Neighbours find_neighbours(const TriangleMesh& mesh)
{
    Neighbours neighbours(mesh.triangles.size());
    for_each_edge(sorted_half_edges(mesh),
                  [&](auto first, auto last)
                  {
                      if (last - first != 2) { return; }
                      const HalfEdge &one = *first, &other = *(first + 1);
                      const bool      opposed = runs_upwards(mesh, one) == runs_upwards(mesh, other);
                      const auto a = static_cast<std::size_t>(one.triangle), i = static_cast<std::size_t>(one.side);
                      const auto b = static_cast<std::size_t>(other.triangle), j = static_cast<std::size_t>(other.side);
                      neighbours[a][i] = {other.triangle, opposed};
                      neighbours[b][j] = {one.triangle, opposed};
                  });
    return neighbours;
}

constexpr std::size_t unknown = static_cast<std::size_t>(-1);

void flood(const Neighbours& neighbours, std::size_t seed, Components& components)
{
    std::vector<std::size_t> pending{seed};
    components.of[seed] = components.count;
    while (!pending.empty())
    {
        const std::size_t at = pending.back();
        pending.pop_back();
        for (const Neighbour& neighbour : neighbours[at])
        {
            if (neighbour.triangle < 0) { continue; }
            const auto next   = static_cast<std::size_t>(neighbour.triangle);
            const auto turned = static_cast<std::uint8_t>(components.turned[at] ^ (neighbour.opposed ? 1 : 0));
            if (components.of[next] == unknown)
            {
                components.of[next]     = components.count;
                components.turned[next] = turned;
                pending.push_back(next);
            }
            else if (components.turned[next] != turned) { ++components.one_sided; }
        }
    }
    ++components.count;
}

} // namespace

Components find_components(const TriangleMesh& mesh)
{
    const Neighbours neighbours = find_neighbours(mesh);
    Components       components;
    components.of.assign(mesh.triangles.size(), unknown);
    components.turned.assign(mesh.triangles.size(), 0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    {
        if (components.of[t] == unknown) { flood(neighbours, t, components); }
    }
    components.one_sided /= 2; // counted from both sides
    return components;
}

std::vector<double> signed_volumes(const TriangleMesh& mesh, const Components& components)
{
    std::vector<Eigen::Vector3d> middles(components.count, Eigen::Vector3d::Zero());
    std::vector<double>          counts(components.count, 0.0), volumes(components.count, 0.0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    {
        middles[components.of[t]] += corner(mesh, t, 0);
        counts[components.of[t]] += 1;
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    {
        const std::size_t     of     = components.of[t];
        const Eigen::Vector3d middle = middles[of] / counts[of];
        const Eigen::Vector3d a = corner(mesh, t, 0) - middle, b = corner(mesh, t, 1) - middle;
        const double          volume = a.dot(b.cross(corner(mesh, t, 2) - middle)) / 6;
        volumes[of] += components.turned[t] != 0 ? -volume : volume;
    }
    return volumes;
}

std::vector<std::vector<std::size_t>> sample_triangles(const TriangleMesh& mesh, const Components& components,
                                                       std::size_t most)
{
    struct Entry
    {
        double      key;
        std::size_t triangle;
    };
    // Exponential variates over the areas: the smallest ones are a sample without replacement, weighted by area
    // (Efraimidis & Spirakis 2006, Inf. Process. Lett. 97:181).
    Random                          random(1);
    std::vector<std::vector<Entry>> entries(components.count);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    {
        entries[components.of[t]].push_back({-std::log1p(-random.uniform()) / area_vector(mesh, t).norm(), t});
    }
    std::vector<std::vector<std::size_t>> samples(components.count);
    for (std::size_t p = 0; p < components.count; ++p)
    {
        std::vector<Entry>& own   = entries[p];
        const std::size_t   count = std::min(most, own.size());
        std::partial_sort(own.begin(), own.begin() + static_cast<std::ptrdiff_t>(count), own.end(),
                          [](const Entry& one, const Entry& other)
                          { return one.key != other.key ? one.key < other.key : one.triangle < other.triangle; });
        for (std::size_t i = 0; i < count; ++i) { samples[p].push_back(own[i].triangle); }
    }
    return samples;
}

} // namespace tread::shape
