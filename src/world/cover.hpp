#pragma once

#include <cstdint>
#include <vector>

#include "kernels/contact/point_body_kern.hpp"
#include "world/world.hpp"

namespace tread::world
{

/// Search radius of point-body contacts, and which bodies are sampled at nine places of a point.
struct PointReach
{
    contact::RadiusRule rule;
    double              sampled_below; ///< m, equivalent radius of a body under which sand samples it; 0 = never

    double radius(double volume) const { return contact::point_radius(volume, rule); }

    /// m, largest distance from a body at which a point of that radius may touch it.
    double search(double radius) const;

    /// The same for the largest of the points; 0 without points.
    double farthest(const Sand& sand) const;
};

/// Equivalent radius of a body, m, under which sand samples it at nine places; 0 = never.
double sampled_below(const scene::Scene& scene, const Sand& sand);

PointReach make_point_reach(const scene::Scene& scene, const Sand& sand);

/// Place of a point that is nearest to a body: its centre, or one of its samples.
struct NearestPlace
{
    double       distance; ///< m, signed distance of the body's surface
    Vec3<double> at;
};

NearestPlace nearest_place(const World& world, const PointReach& reach, std::size_t body, const Vec3<double>& x,
                           double radius);

/// Counts for each body the sand points that lie in it or are within their contact radius of it (phi < r_p), by their
/// centre or one of their samples, and touch it in the first phase; a point counts for one body only. Sand that starts
/// in such contact would be ejected.
std::vector<std::int64_t> covered_points(const scene::Scene& scene, const World& world);

} // namespace tread::world
