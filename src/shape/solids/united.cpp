#include "shape/solids/united.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "shape/mesh/mesh_reader.hpp"
#include "shape/mesh/refinement.hpp"
#include "shape/mesh/triangle.hpp"
#include "shape/solids/sampled_mass.hpp"

namespace tread::shape
{
namespace
{

constexpr double finest_share   = 1.0 / 256; ///< of the largest extent: pieces of the boundary where parts meet
constexpr double coarsest_share = 1.0 / 32;
constexpr double flush_share    = 1e-6; ///< surfaces nearer to each other than this coincide
constexpr double probe_share    = 1e-4; ///< from a surface to its two sides

Bounds bounds_of(const std::vector<Solid>& solids)
{
    Bounds box = bounds(solids.front().surface);
    for (const Solid& solid : solids)
    {
        const Bounds one = bounds(solid.surface);
        box              = {box.low.cwiseMin(one.low), box.high.cwiseMax(one.high)};
    }
    return box;
}

Bounds shared_by(const Bounds& a, const Bounds& b) { return {a.low.cwiseMax(b.low), a.high.cwiseMin(b.high)}; }

bool is_empty(const Bounds& box) { return (box.extent().array() <= 0).any(); }

double distance_to(const Bounds& box, const Eigen::Vector3d& point)
{
    return (box.low - point).cwiseMax(point - box.high).cwiseMax(0.0).norm();
}

/// Solids with what is needed to decide which of their surfaces bound the union.
struct Parts
{
    std::vector<MeshDistance> distances;
    std::vector<Bounds>       boxes;
    double                    extent; ///< m, largest of the union
};

Parts prepare_parts(const std::vector<Solid>& solids)
{
    Parts parts{{}, {}, bounds_of(solids).extent().maxCoeff()};
    for (const Solid& solid : solids)
    {
        parts.distances.push_back(prepare_distance(solid));
        parts.boxes.push_back(bounds(solid.surface));
    }
    return parts;
}

/// Finds the pieces of one part's surface that no other part covers.
struct PieceFinder
{
    const Parts& parts;
    std::size_t  part;

    /// Decides by its middle whether a piece that is as small as pieces get bounds the union. Where surfaces of parts
    /// coincide, they bound nothing if they face each other, and the first part has them if they face the same way.
    bool bounds_the_union(const Corners& piece) const
    {
        const Eigen::Vector3d middle = (piece[0] + piece[1] + piece[2]) / 3;
        const Eigen::Vector3d probe =
            probe_share * parts.extent * (piece[1] - piece[0]).cross(piece[2] - piece[0]).normalized();
        const double flush = flush_share * parts.extent;
        for (std::size_t other = 0; other < parts.distances.size(); ++other)
        {
            if (other == part || distance_to(parts.boxes[other], middle) > flush) { continue; }
            const double distance = signed_distance(parts.distances[other], middle);
            if (distance > flush) { continue; }
            if (distance < -flush) { return false; }
            const bool before = signed_distance(parts.distances[other], middle + probe) < 0;
            const bool behind = signed_distance(parts.distances[other], middle - probe) < 0;
            if (before || (behind && other < part)) { return false; }
        }
        return true;
    }

    /// Adds the parts of a piece that bound the union; bisects it while another part's surface is near.
    void collect(const Corners& piece, std::vector<Corners>& kept) const
    {
        const Eigen::Vector3d       middle = (piece[0] + piece[1] + piece[2]) / 3;
        const std::array<double, 3> lengths{(piece[1] - piece[0]).norm(), (piece[2] - piece[1]).norm(),
                                            (piece[0] - piece[2]).norm()};
        const auto                  longest =
            static_cast<std::size_t>(std::max_element(lengths.begin(), lengths.end()) - lengths.begin());
        const double radius =
            std::max({(piece[0] - middle).norm(), (piece[1] - middle).norm(), (piece[2] - middle).norm()}) +
            flush_share * parts.extent;
        bool near = false;
        for (std::size_t other = 0; other < parts.distances.size() && !near; ++other)
        {
            if (other == part || distance_to(parts.boxes[other], middle) > radius) { continue; }
            const double distance = signed_distance(parts.distances[other], middle);
            if (distance < -radius) { return; }
            near = distance <= radius;
        }
        if (!near) { kept.push_back(piece); }
        else if (lengths[longest] <= finest_share * parts.extent)
        {
            if (bounds_the_union(piece)) { kept.push_back(piece); }
        }
        else
        {
            const Eigen::Vector3d &a = piece[longest], &b = piece[(longest + 1) % 3], &c = piece[(longest + 2) % 3];
            const Eigen::Vector3d  m = 0.5 * (a + b);
            collect({a, m, c}, kept);
            collect({m, b, c}, kept);
        }
    }
};

void append_boundary(const Parts& parts, std::size_t part, const TriangleMesh& surface, TriangleMesh& boundary)
{
    // Coarse triangles would be split up to edges far from where parts meet, whose sharpness would be lost.
    const TriangleMesh                mesh = refined(surface, coarsest_share * parts.extent);
    const PieceFinder                 finder{parts, part};
    std::vector<std::vector<Corners>> kept(mesh.triangles.size());
#pragma omp parallel for schedule(dynamic, 64)
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) { finder.collect(corners(mesh, t), kept[t]); }
    for (const auto& pieces : kept)
    {
        for (const Corners& piece : pieces)
        {
            const auto first = static_cast<std::int32_t>(boundary.vertices.size());
            boundary.vertices.insert(boundary.vertices.end(), piece.begin(), piece.end());
            boundary.triangles.push_back({first, first + 1, first + 2});
        }
    }
}

/// Moments about `origin` of what a part shares with those before it.
Moments shared_with_earlier(const Parts& parts, std::size_t part, const Eigen::Vector3d& origin)
{
    std::vector<std::size_t> earlier;
    Bounds                   box{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    for (std::size_t other = 0; other < part; ++other)
    {
        const Bounds shared = shared_by(parts.boxes[part], parts.boxes[other]);
        if (is_empty(shared)) { continue; }
        box = earlier.empty() ? shared : Bounds{box.low.cwiseMin(shared.low), box.high.cwiseMax(shared.high)};
        earlier.push_back(other);
    }
    if (earlier.empty()) { return {}; }
    const auto depth = [&](const Eigen::Vector3d& place)
    {
        double deepest = -std::numeric_limits<double>::infinity();
        for (const std::size_t other : earlier)
        {
            deepest = std::max(deepest, -signed_distance(parts.distances[other], place));
        }
        return std::min(deepest, -signed_distance(parts.distances[part], place));
    };
    return sampled_moments(box, origin, depth);
}

/// What several parts hold counts once: each part adds what no part before it holds.
MassProperties united_mass(const std::vector<Solid>& solids, const Parts& parts, Solid& result)
{
    const Eigen::Vector3d origin = 0.5 * (parts.boxes.front().low + parts.boxes.front().high);
    Moments               sum;
    double                shared = 0;
    for (std::size_t p = 0; p < solids.size(); ++p)
    {
        const Moments again = shared_with_earlier(parts, p, origin);
        sum += moments_of(solids[p].unit, origin);
        sum -= again;
        shared += again.volume;
    }
    result.remarks.push_back(
        fmt::format("union of {} solids; {:.3g} m3 that several of them hold count once, {:.3g} of "
                    "the volume",
                    solids.size(), shared, shared / sum.volume));
    return mass_of(sum, origin);
}

/// Takes unions apart, so that none holds another.
std::vector<Solid> flattened(std::vector<Solid> solids)
{
    std::vector<Solid> flat;
    for (Solid& solid : solids)
    {
        if (solid.united.empty()) { flat.push_back(std::move(solid)); }
        else { std::move(solid.united.begin(), solid.united.end(), std::back_inserter(flat)); }
    }
    return flat;
}

} // namespace

void place(Solid& solid, const Placing& placing)
{
    const auto moved = [&](const Eigen::Vector3d& x) -> Eigen::Vector3d
    { return placing.at + placing.scale * (placing.rotation * x); };
    for (Eigen::Vector3d& vertex : solid.surface.vertices) { vertex = moved(vertex); }
    for (Eigen::Vector3d& vertex : solid.parts.vertices) { vertex = moved(vertex); }
    solid.unit.centre = moved(solid.unit.centre);
    solid.unit.volume *= std::pow(placing.scale, 3);
    solid.unit.inertia =
        std::pow(placing.scale, 5) * (placing.rotation * solid.unit.inertia * placing.rotation.transpose());
    for (Solid& part : solid.united) { place(part, placing); }
}

Solid united(std::vector<Solid> solids, const std::string& origin)
{
    Solid       result{{}, {}, SignRule::any_part, {}, {}, flattened(std::move(solids))};
    const Parts parts = prepare_parts(result.united);
    for (std::size_t p = 0; p < result.united.size(); ++p)
    {
        for (const std::string& remark : result.united[p].remarks)
        {
            result.remarks.push_back(fmt::format("part {}: {}", p, remark));
        }
        append_boundary(parts, p, result.united[p].surface, result.surface);
    }
    if (result.surface.triangles.empty())
    {
        throw InputError(fmt::format("{}: its parts have no surface left", origin));
    }
    result.surface = weld(result.surface);
    result.unit    = united_mass(result.united, parts, result);
    return result;
}

UnitedDistance prepare_united_distance(const Solid& solid)
{
    Parts parts = prepare_parts(solid.united);
    return {std::move(parts.distances), build_tree(solid.surface), finest_share * parts.extent};
}

double signed_distance(const UnitedDistance& distance, const Eigen::Vector3d& point)
{
    double least = std::numeric_limits<double>::infinity();
    for (const MeshDistance& part : distance.parts) { least = std::min(least, signed_distance(part, point)); }
    if (least > 0) { return least; }
    const double boundary = std::sqrt(closest_point(distance.boundary, point).squared_distance);
    return std::min(least, distance.finest - boundary);
}

} // namespace tread::shape
