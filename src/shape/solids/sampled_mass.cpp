#include "shape/solids/sampled_mass.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tread::shape
{
namespace
{

void add(Moments& sum, double portion, const Eigen::Vector3d& centre, double side)
{
    sum.volume += portion;
    sum.first += portion * centre;
    sum.second += portion * (centre * centre.transpose() + side * side / 12 * Eigen::Matrix3d::Identity());
}

constexpr int coarse = 16; ///< cubes along the longest extent
constexpr int halved = 3;  ///< levels of subdivision at the surface

/// Depth at a place, and the part (0 to 1) of a smallest cube that counts, from its middle, side and depth.
template<class Depth, class Part>
struct Integrator
{
    const Depth&    depth_at;
    const Part&     part_of;
    Eigen::Vector3d origin; ///< of the moments and of `centre` below

    /// Adds the inner part of a cube: all or nothing if the surface is too far off to cut it.
    void integrate(const Eigen::Vector3d& centre, double side, int level, Moments& sum) const
    {
        const double depth = depth_at(origin + centre);
        const bool   whole = std::abs(depth) > 0.5 * std::sqrt(3.0) * side;
        if (level == halved || whole)
        {
            const double part = whole ? (depth > 0 ? 1.0 : 0.0) : part_of(origin + centre, side, depth);
            if (part > 0) { add(sum, part * side * side * side, centre, side); }
            return;
        }
        for (int c = 0; c < 8; ++c)
        {
            const Eigen::Vector3d way((c & 1) - 0.5, ((c >> 1) & 1) - 0.5, (c >> 2) - 0.5);
            integrate(centre + 0.5 * side * way, 0.5 * side, level + 1, sum);
        }
    }
};

/// Moments about the middle of the box.
template<class Depth, class Part>
Moments integrated(const Bounds& box, const Depth& depth, const Part& part)
{
    const double                  side = box.extent().maxCoeff() / coarse;
    const Integrator<Depth, Part> inner{depth, part, 0.5 * (box.low + box.high)};
    std::vector<Moments>          parts(coarse * coarse * coarse);
#pragma omp parallel for schedule(dynamic, 1)
    for (std::size_t p = 0; p < parts.size(); ++p)
    {
        const int at = static_cast<int>(p), i = at % coarse, j = at / coarse % coarse, k = at / (coarse * coarse);
        const Eigen::Vector3d place(i + 0.5, j + 0.5, k + 0.5);
        inner.integrate(side * (place - Eigen::Vector3d::Constant(0.5 * coarse)), side, 0, parts[p]);
    }
    Moments sum;
    for (const Moments& one : parts) { sum += one; }
    return sum;
}

/// Part of a cube as if the surface were a plane perpendicular to an axis.
double cut_by_plane(double side, double depth) { return std::clamp(0.5 + depth / side, 0.0, 1.0); }

} // namespace

Moments& Moments::operator+=(const Moments& other)
{
    volume += other.volume;
    first += other.first;
    second += other.second;
    return *this;
}

Moments& Moments::operator-=(const Moments& other)
{
    volume -= other.volume;
    first -= other.first;
    second -= other.second;
    return *this;
}

Moments moments_of(const MassProperties& mass, const Eigen::Vector3d& origin)
{
    const Eigen::Vector3d arm        = mass.centre - origin;
    const Eigen::Matrix3d covariance = 0.5 * mass.inertia.trace() * Eigen::Matrix3d::Identity() - mass.inertia;
    return {mass.volume, mass.volume * arm, covariance + mass.volume * arm * arm.transpose()};
}

MassProperties mass_of(const Moments& moments, const Eigen::Vector3d& origin)
{
    const Eigen::Vector3d centre     = moments.first / moments.volume;
    const Eigen::Matrix3d covariance = moments.second - moments.volume * centre * centre.transpose();
    return {moments.volume, origin + centre, covariance.trace() * Eigen::Matrix3d::Identity() - covariance};
}

MassProperties sampled_mass_properties(const Bounds& box, const MeshDistance& distance)
{
    const auto depth = [&](const Eigen::Vector3d& place) { return -signed_distance(distance, place); };
    const auto part  = [](const Eigen::Vector3d&, double side, double at) { return cut_by_plane(side, at); };
    return mass_of(integrated(box, depth, part), 0.5 * (box.low + box.high));
}

Moments sampled_moments(const Bounds& box, const Eigen::Vector3d& origin,
                        const std::function<double(const Eigen::Vector3d&)>& depth)
{
    const double least = 1e-9 * box.extent().maxCoeff();
    const auto   part  = [&](const Eigen::Vector3d& centre, double side, double at)
    {
        bool inside = at > least;
        for (int c = 0; c < 8 && !inside; ++c)
        {
            const Eigen::Vector3d way((c & 1) - 0.5, ((c >> 1) & 1) - 0.5, (c >> 2) - 0.5);
            inside = depth(centre + 0.5 * side * way) > least;
        }
        return inside ? cut_by_plane(side, at) : 0.0;
    };
    const Eigen::Vector3d middle = 0.5 * (box.low + box.high);
    const Moments         local  = integrated(box, depth, part);
    if (local.volume == 0) { return {}; }
    return moments_of(mass_of(local, middle), origin);
}

} // namespace tread::shape
