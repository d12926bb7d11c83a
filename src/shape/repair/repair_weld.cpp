#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "shape/mesh/triple_hash.hpp"
#include "shape/repair/repair_steps.hpp"

namespace tread::shape
{
namespace
{

/// STL and short decimals hold coordinates in single precision: vertices that they separate differ by a few roundings.
double weld_tolerance(const Bounds& box)
{
    const double coordinate = std::max(box.low.cwiseAbs().maxCoeff(), box.high.cwiseAbs().maxCoeff());
    return std::max(1e-6 * box.extent().maxCoeff(), std::ldexp(coordinate, -22));
}

using Cell = std::array<std::int64_t, 3>;

/// Vertices that represent all others within the tolerance, in a hash of cells several tolerances wide.
class Representatives
{
public:
    Representatives(const Eigen::Vector3d& low, double tolerance, std::size_t expected)
        : low_(low)
        , tolerance_(tolerance)
        , width_(8 * tolerance)
    {
        first_.reserve(expected);
    }

    /// Index of the representative of `place`; adds it if there is none yet.
    std::int32_t find_or_add(const Eigen::Vector3d& place)
    {
        const Cell from = cell_of(place - Eigen::Vector3d::Constant(tolerance_));
        const Cell to   = cell_of(place + Eigen::Vector3d::Constant(tolerance_));
        for (std::int64_t z = from[2]; z <= to[2]; ++z)
        {
            for (std::int64_t y = from[1]; y <= to[1]; ++y)
            {
                for (std::int64_t x = from[0]; x <= to[0]; ++x)
                {
                    if (const auto found = find_in({x, y, z}, place)) { return *found; }
                }
            }
        }
        return add(place);
    }

    std::vector<Eigen::Vector3d> places;

private:
    Cell cell_of(const Eigen::Vector3d& place) const
    {
        const Eigen::Vector3d in_cells = (place - low_) / width_;
        return {static_cast<std::int64_t>(std::floor(in_cells.x())),
                static_cast<std::int64_t>(std::floor(in_cells.y())),
                static_cast<std::int64_t>(std::floor(in_cells.z()))};
    }

    std::optional<std::int32_t> find_in(const Cell& cell, const Eigen::Vector3d& place) const
    {
        const auto entry = first_.find(cell);
        for (std::int32_t at = entry == first_.end() ? -1 : entry->second; at >= 0;)
        {
            const auto index = static_cast<std::size_t>(at);
            if ((places[index] - place).squaredNorm() <= tolerance_ * tolerance_) { return at; }
            at = next_[index];
        }
        return std::nullopt;
    }

    std::int32_t add(const Eigen::Vector3d& place)
    {
        const auto index     = static_cast<std::int32_t>(places.size());
        const auto [at, now] = first_.try_emplace(cell_of(place), index);
        next_.push_back(now ? -1 : at->second);
        at->second = index;
        places.push_back(place);
        return index;
    }

    Eigen::Vector3d                                    low_;
    double                                             tolerance_;
    double                                             width_;
    std::unordered_map<Cell, std::int32_t, TripleHash> first_; ///< first representative of each cell
    std::vector<std::int32_t>                          next_;  ///< next one in the same cell, -1 = none
};

} // namespace

void weld_near(TriangleMesh& mesh, RepairReport& report)
{
    if (mesh.vertices.empty()) { return; }
    const Bounds box = bounds(mesh);
    report.tolerance = weld_tolerance(box);
    if (!(report.tolerance > 0)) { return; }

    Representatives           representatives(box.low, report.tolerance, mesh.vertices.size());
    std::vector<std::int32_t> now;
    now.reserve(mesh.vertices.size());
    for (const Eigen::Vector3d& vertex : mesh.vertices) { now.push_back(representatives.find_or_add(vertex)); }
    for (auto& triangle : mesh.triangles)
    {
        for (std::int32_t& vertex : triangle) { vertex = now[static_cast<std::size_t>(vertex)]; }
    }
    report.welded_vertices = static_cast<std::int64_t>(mesh.vertices.size() - representatives.places.size());
    mesh.vertices          = std::move(representatives.places);
}

} // namespace tread::shape
