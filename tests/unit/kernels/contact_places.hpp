#pragma once

#include <random>

#include "contact_scene.hpp"

// Points on a slab and around a ball.
namespace tread::test
{

inline const double radius = contact::point_radius(SceneNumbers{}.volume, contact::RadiusRule::sphere);

inline AnalyticShape slab() { return box_shape({0.1, 0.1, 0.02}, std::numeric_limits<double>::infinity(), 40); }

/// A slab below the point (0.5, 0.5, 0.3), its upper face at z = 0.3.
inline BodyState slab_below() { return {{0.5, 0.5, 0.28}}; }

inline Vec3<double> point_over_slab(double overlap) { return {0.503, 0.497, 0.3 + radius - overlap}; }

/// Points scattered in the skin of a sphere of radius 0.05 at the centre of the domain, sliding over it.
inline std::vector<PointState> skin(std::size_t count)
{
    std::mt19937                           random(11);
    std::normal_distribution<double>       normal;
    std::uniform_real_distribution<double> depth(0, 0.5 * radius);
    std::vector<PointState>                sand;
    for (std::size_t i = 0; i < count; ++i)
    {
        const Vec3<double> outwards = Vec3<double>(normal(random), normal(random), normal(random)).normalized();
        sand.push_back({Vec3<double>::Constant(0.5) + (0.05 + radius - depth(random)) * outwards,
                        0.1 * Vec3<double>(normal(random), normal(random), normal(random))});
    }
    return sand;
}

inline BodyState ball() { return {Vec3<double>::Constant(0.5), Quat::Identity(), {0.1, 0, 0}, {0, 3, 1}}; }

} // namespace tread::test
