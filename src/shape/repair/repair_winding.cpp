#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "shape/mesh/components.hpp"
#include "shape/mesh/triangle.hpp"
#include "shape/repair/repair_steps.hpp"

namespace tread::shape
{
namespace
{

void turn(TriangleMesh& mesh, std::size_t triangle)
{
    std::swap(mesh.triangles[triangle][1], mesh.triangles[triangle][2]);
}

void turn_parts(TriangleMesh& mesh, const Components& parts, const std::vector<std::uint8_t>& which)
{
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    {
        if (which[parts.of[t]] != 0) { turn(mesh, t); }
    }
}

/// Number of other parts that contain each part entirely.
std::vector<int> depths(const TriangleMesh& mesh, const Components& parts)
{
    std::vector<int> depth;
    for (const auto& holders : find_holders(mesh, parts)) { depth.push_back(static_cast<int>(holders.size())); }
    return depth;
}

/// Whether all parts that no other part contains face the same way in the file.
bool outer_parts_agree(const std::vector<int>& depth, const std::vector<std::uint8_t>& inwards)
{
    bool any[2] = {false, false};
    for (std::size_t p = 0; p < depth.size(); ++p)
    {
        if (depth[p] == 0) { any[inwards[p]] = true; }
    }
    return !(any[0] && any[1]);
}

/// Which parts, all facing outwards now, bound a cavity.
std::vector<std::uint8_t> find_cavities(const std::vector<int>& depth, const std::vector<std::uint8_t>& inwards,
                                        Winding winding)
{
    const bool         trusted = winding == Winding::consistent && outer_parts_agree(depth, inwards);
    const auto         outer   = std::find(depth.begin(), depth.end(), 0);
    const std::uint8_t usual   = outer == depth.end() ? 0 : inwards[static_cast<std::size_t>(outer - depth.begin())];
    std::vector<std::uint8_t> cavity(depth.size(), 0);
    for (std::size_t p = 0; p < depth.size(); ++p)
    {
        if (depth[p] == 0) { continue; }
        cavity[p] = static_cast<std::uint8_t>(trusted ? inwards[p] != usual : depth[p] % 2 == 1);
    }
    return cavity;
}

} // namespace

Winding wind_alike(TriangleMesh& mesh, RepairReport& report)
{
    const Components          parts = find_components(mesh);
    std::vector<std::int64_t> size(parts.count, 0), turned(parts.count, 0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    {
        ++size[parts.of[t]];
        turned[parts.of[t]] += parts.turned[t];
    }
    std::int64_t changed = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    {
        // The smaller group is reversed.
        const std::size_t part     = parts.of[t];
        const bool        minority = 2 * turned[part] <= size[part];
        if ((parts.turned[t] != 0) != minority) { continue; }
        turn(mesh, t);
        ++changed;
    }
    report.turned_triangles += changed;
    return changed == 0 ? Winding::consistent : Winding::mixed;
}

void orient_parts(TriangleMesh& mesh, Winding winding, RepairReport& report)
{
    const Components          parts   = find_components(mesh);
    const std::vector<double> volumes = signed_volumes(mesh, parts);
    std::vector<std::uint8_t> inwards(parts.count);
    for (std::size_t p = 0; p < parts.count; ++p) { inwards[p] = volumes[p] < 0 ? 1 : 0; }
    turn_parts(mesh, parts, inwards);
    if (parts.count == 0) { return; }
    const std::vector<std::uint8_t> cavity = find_cavities(depths(mesh, parts), inwards, winding);
    turn_parts(mesh, parts, cavity);
    for (std::size_t p = 0; p < parts.count; ++p)
    {
        report.cavities += cavity[p];
        report.turned_parts += inwards[p] != cavity[p] ? 1 : 0;
    }
}

} // namespace tread::shape
