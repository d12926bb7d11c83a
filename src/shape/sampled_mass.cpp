#include "shape/sampled_mass.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tread::shape
{
namespace
{

/// Integrals of 1, x and x x^T.
struct Moments
{
    double          volume = 0;
    Eigen::Vector3d first  = Eigen::Vector3d::Zero();
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();

    void add(double portion, const Eigen::Vector3d& centre, double side)
    {
        volume += portion;
        first += portion * centre;
        second += portion * (centre * centre.transpose() + side * side / 12 * Eigen::Matrix3d::Identity());
    }

    void add(const Moments& other)
    {
        volume += other.volume;
        first += other.first;
        second += other.second;
    }
};

constexpr int coarse = 16; ///< cubes along the longest extent
constexpr int halved = 3;  ///< levels of subdivision at the surface

struct Integrator
{
    const MeshDistance& distance;
    Eigen::Vector3d     origin; ///< of the moments and of `centre` below

    /// Adds the inner part of a cube: all or nothing if the surface is too far off to cut it; in the smallest cubes as
    /// if the surface were a plane perpendicular to an axis.
    void integrate(const Eigen::Vector3d& centre, double side, int level, Moments& sum) const
    {
        const double depth = -signed_distance(distance, origin + centre);
        if (level == halved || std::abs(depth) > 0.5 * std::sqrt(3.0) * side)
        {
            const double part = std::clamp(0.5 + depth / side, 0.0, 1.0);
            if (part > 0) { sum.add(part * side * side * side, centre, side); }
            return;
        }
        for (int c = 0; c < 8; ++c)
        {
            const Eigen::Vector3d way((c & 1) - 0.5, ((c >> 1) & 1) - 0.5, (c >> 2) - 0.5);
            integrate(centre + 0.5 * side * way, 0.5 * side, level + 1, sum);
        }
    }
};

} // namespace

MassProperties sampled_mass_properties(const Bounds& box, const MeshDistance& distance)
{
    const double         side = box.extent().maxCoeff() / coarse;
    const Integrator     inner{distance, 0.5 * (box.low + box.high)};
    std::vector<Moments> parts(coarse * coarse * coarse);
#pragma omp parallel for schedule(dynamic, 1)
    for (std::size_t p = 0; p < parts.size(); ++p)
    {
        const int at = static_cast<int>(p), i = at % coarse, j = at / coarse % coarse, k = at / (coarse * coarse);
        const Eigen::Vector3d place(i + 0.5, j + 0.5, k + 0.5);
        inner.integrate(side * (place - Eigen::Vector3d::Constant(0.5 * coarse)), side, 0, parts[p]);
    }
    Moments sum;
    for (const Moments& part : parts) { sum.add(part); }

    const Eigen::Vector3d centre     = sum.first / sum.volume;
    const Eigen::Matrix3d covariance = sum.second - sum.volume * centre * centre.transpose();
    return {sum.volume, inner.origin + centre, covariance.trace() * Eigen::Matrix3d::Identity() - covariance};
}

} // namespace tread::shape
