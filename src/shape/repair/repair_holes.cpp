#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "shape/mesh/half_edges.hpp"
#include "shape/mesh/triangle.hpp"
#include "shape/repair/repair_steps.hpp"

namespace tread::shape
{
namespace
{

using Loop      = std::vector<std::int32_t>;
using Triangles = std::vector<std::array<std::int32_t, 3>>;

/// Missing half edges along open edges, from vertex to vertex, sorted.
std::vector<std::pair<std::int32_t, std::int32_t>> missing_sides(const TriangleMesh& mesh)
{
    std::vector<std::pair<std::int32_t, std::int32_t>> sides;
    for_each_edge(sorted_half_edges(mesh),
                  [&](auto first, auto last)
                  {
                      if (last - first != 1) { return; }
                      const bool upwards = runs_upwards(mesh, *first);
                      sides.emplace_back(upwards ? first->high : first->low, upwards ? first->low : first->high);
                  });
    std::sort(sides.begin(), sides.end());
    return sides;
}

/// Follows missing half edges; where a path meets itself, it splits off a loop.
class LoopFinder
{
public:
    explicit LoopFinder(const TriangleMesh& mesh)
        : sides_(missing_sides(mesh))
        , used_(sides_.size(), 0)
        , place_(mesh.vertices.size(), -1)
    {
        for (std::size_t s = 0; s < sides_.size(); ++s)
        {
            if (used_[s] == 0) { walk(sides_[s].first); }
        }
    }

    std::vector<Loop> loops;

private:
    void walk(std::int32_t start)
    {
        Loop path;
        for (std::int32_t at = start; at >= 0; at = step(at))
        {
            std::int32_t& place = place_[static_cast<std::size_t>(at)];
            if (place >= 0)
            {
                const auto first = path.begin() + place;
                loops.emplace_back(first, path.end());
                for (auto vertex = first; vertex != path.end(); ++vertex) { forget(*vertex); }
                path.erase(first, path.end());
            }
            place = static_cast<std::int32_t>(path.size());
            path.push_back(at);
        }
        for (const std::int32_t vertex : path) { forget(vertex); }
    }

    void forget(std::int32_t vertex) { place_[static_cast<std::size_t>(vertex)] = -1; }

    /// End of the first unused half edge from here; -1 if there is none.
    std::int32_t step(std::int32_t from)
    {
        const auto first = std::lower_bound(sides_.begin(), sides_.end(), std::pair(from, std::int32_t{-1}));
        for (auto side = first; side != sides_.end() && side->first == from; ++side)
        {
            std::uint8_t& used = used_[static_cast<std::size_t>(side - sides_.begin())];
            if (used != 0) { continue; }
            used = 1;
            return side->second;
        }
        return -1;
    }

    std::vector<std::pair<std::int32_t, std::int32_t>> sides_;
    std::vector<std::uint8_t>                          used_;
    std::vector<std::int32_t>                          place_; ///< position of each vertex on the path, -1 = not on it
};

/// Triangulation of least area (Barequet & Sharir 1995, Comput. Aided Geom. Des. 12:207): the cost of the part of the
/// loop from i to j is the minimum over its apex k. Triangles without area cost more than all others together.
class LeastArea
{
public:
    LeastArea(const TriangleMesh& mesh, const Loop& loop, double forbidden)
        : mesh_{mesh}
        , loop_{loop}
        , forbidden_(forbidden)
        , cost_(loop.size() * loop.size(), 0.0)
        , apex_(loop.size() * loop.size(), 0)
    {
        for (std::size_t span = 2; span < loop.size(); ++span)
        {
            for (std::size_t i = 0; i + span < loop.size(); ++i) { choose(i, i + span); }
        }
    }

    Triangles triangles() const
    {
        Triangles                                        result;
        std::vector<std::pair<std::size_t, std::size_t>> pending{{0, loop_.size() - 1}};
        while (!pending.empty())
        {
            const auto [i, j] = pending.back();
            pending.pop_back();
            if (j - i < 2) { continue; }
            const std::size_t k = apex_[at(i, j)];
            result.push_back({loop_[i], loop_[k], loop_[j]});
            pending.emplace_back(i, k);
            pending.emplace_back(k, j);
        }
        return result;
    }

private:
    std::size_t at(std::size_t i, std::size_t j) const { return i * loop_.size() + j; }

    double area(std::size_t i, std::size_t k, std::size_t j) const
    {
        const TriangleMesh single{{mesh_.vertices[static_cast<std::size_t>(loop_[i])],
                                   mesh_.vertices[static_cast<std::size_t>(loop_[k])],
                                   mesh_.vertices[static_cast<std::size_t>(loop_[j])]},
                                  {{0, 1, 2}}};
        return is_degenerate(single, 0) ? forbidden_ : area_vector(single, 0).norm();
    }

    void choose(std::size_t i, std::size_t j)
    {
        double best = std::numeric_limits<double>::infinity();
        for (std::size_t k = i + 1; k < j; ++k)
        {
            const double cost = cost_[at(i, k)] + cost_[at(k, j)] + area(i, k, j);
            if (cost >= best) { continue; }
            best            = cost;
            apex_[at(i, j)] = k;
        }
        cost_[at(i, j)] = best;
    }

    const TriangleMesh&      mesh_;
    const Loop&              loop_;
    double                   forbidden_;
    std::vector<double>      cost_;
    std::vector<std::size_t> apex_;
};

/// Triangle fan about the middle of the loop, which becomes a new vertex.
Triangles fan(TriangleMesh& mesh, const Loop& loop)
{
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const std::int32_t vertex : loop)
    {
        middle += mesh.vertices[static_cast<std::size_t>(vertex)] / static_cast<double>(loop.size());
    }
    const auto apex = static_cast<std::int32_t>(mesh.vertices.size());
    mesh.vertices.push_back(middle);
    Triangles triangles;
    for (std::size_t i = 0; i < loop.size(); ++i) { triangles.push_back({loop[i], loop[(i + 1) % loop.size()], apex}); }
    return triangles;
}

double extent_of(const TriangleMesh& mesh, const Loop& loop)
{
    TriangleMesh rim;
    for (const std::int32_t vertex : loop) { rim.vertices.push_back(mesh.vertices[static_cast<std::size_t>(vertex)]); }
    return bounds(rim).extent().maxCoeff();
}

bool close(TriangleMesh& mesh, const Loop& loop, double extent)
{
    constexpr std::size_t most_exact = 64; // the search has cubic cost in this
    const std::size_t     before     = mesh.triangles.size();
    const Triangles       lid =
        loop.size() <= most_exact ? LeastArea(mesh, loop, 1e3 * extent * extent).triangles() : fan(mesh, loop);
    mesh.triangles.insert(mesh.triangles.end(), lid.begin(), lid.end());
    for (std::size_t t = before; t < mesh.triangles.size(); ++t)
    {
        if (!is_degenerate(mesh, t)) { continue; }
        mesh.triangles.resize(before);
        return false;
    }
    return true;
}

} // namespace

void close_holes(TriangleMesh& mesh, RepairReport& report)
{
    constexpr std::size_t few_edges = 4;
    constexpr double      small     = 0.1; // of the mesh's extent

    if (mesh.triangles.empty()) { return; }
    const double extent = bounds(mesh).extent().maxCoeff();
    for (const Loop& loop : LoopFinder(mesh).loops)
    {
        const std::size_t before   = mesh.triangles.size();
        const bool        is_small = loop.size() <= few_edges || extent_of(mesh, loop) <= small * extent;
        if (loop.size() < 3 || !is_small || !close(mesh, loop, extent))
        {
            ++report.open_holes;
            continue;
        }
        ++report.closed_holes;
        report.hole_triangles += static_cast<std::int64_t>(mesh.triangles.size() - before);
    }
}

} // namespace tread::shape
