#include "shape/mesh/triangle_crossing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace tread::shape
{
namespace
{

/// Whether moving one projection on the axis by at most `slack` (m) separates the two.
bool apart_along(const Eigen::Vector3d& axis, const Corners& one, const Corners& other, double slack)
{
    const auto [one_low, one_high]     = std::minmax({axis.dot(one[0]), axis.dot(one[1]), axis.dot(one[2])});
    const auto [other_low, other_high] = std::minmax({axis.dot(other[0]), axis.dot(other[1]), axis.dot(other[2])});
    return std::min(one_high - other_low, other_high - one_low) <= slack * axis.norm();
}

} // namespace

bool crosses(const Corners& one, const Corners& other, double slack)
{
    std::array<Eigen::Vector3d, 3> side, across;
    for (std::size_t i = 0; i < 3; ++i)
    {
        side[i]   = (one[(i + 1) % 3] - one[i]).normalized();
        across[i] = (other[(i + 1) % 3] - other[i]).normalized();
    }
    const Eigen::Vector3d normal = side[0].cross(side[1]), other_normal = across[0].cross(across[1]);
    const auto            apart    = [&](const Eigen::Vector3d& axis) { return apart_along(axis, one, other, slack); };
    constexpr double      parallel = 1e-6;
    if (normal.cross(other_normal).norm() <= parallel * normal.norm() * other_normal.norm())
    {
        // Parallel planes: crossing is possible only if the planes coincide.
        const double gap = std::abs(normal.dot(other[0] - one[0]));
        if (gap > slack * normal.norm()) { return false; }
        for (std::size_t i = 0; i < 3; ++i)
        {
            if (apart(normal.cross(side[i])) || apart(normal.cross(across[i]))) { return false; }
        }
        return true;
    }
    if (apart(normal) || apart(other_normal)) { return false; }
    for (const Eigen::Vector3d& a : side)
    {
        for (const Eigen::Vector3d& b : across)
        {
            const Eigen::Vector3d axis = a.cross(b);
            if (axis.norm() > parallel && apart(axis)) { return false; }
        }
    }
    return true;
}

bool lies_within(const Corners& piece, const Corners& other, double slack)
{
    const Eigen::Vector3d normal = (other[1] - other[0]).cross(other[2] - other[0]).normalized();
    if (normal.isZero()) { return false; }
    const auto is_within = [&](const Eigen::Vector3d& point)
    {
        if (std::abs(normal.dot(point - other[0])) > slack) { return false; }
        for (std::size_t i = 0; i < 3; ++i)
        {
            const Eigen::Vector3d inwards = normal.cross(other[(i + 1) % 3] - other[i]).normalized();
            if (inwards.dot(point - other[i]) < -slack) { return false; }
        }
        return true;
    };
    return std::all_of(piece.begin(), piece.end(), is_within);
}

} // namespace tread::shape
