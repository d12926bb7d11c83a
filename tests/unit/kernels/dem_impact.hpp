#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "dem_scene.hpp"

// Impacts of exact spheres on a plane or each other, with closed-form solutions.
namespace tread::test
{

inline constexpr double degree = std::numbers::pi / 180;

inline const dem::Plane ground{{0, 0, 1}, 0.0, false};

/// Checks within a relative `tolerance` of the expected value.
inline void expect_close(const char* what, double found, double expected, double tolerance)
{
    std::printf("%s: %.7g, expected %.7g, off by %.1e of it, tolerance %.1e\n", what, found, expected,
                std::abs(found / expected - 1), tolerance);
    EXPECT_NEAR(found, expected, tolerance * std::abs(expected)) << what;
}

struct Impact
{
    double force    = 0; ///< N, largest
    double approach = 0; ///< m, largest
    double duration = 0; ///< s
};

/// Follows body 0 from first to last contact.
template<class Scene, class Approach>
Impact follow(Scene& scene, double dt, int steps, Approach approach)
{
    Impact impact;
    for (int step = 0; step < steps; ++step)
    {
        scene.run(dt, 1);
        const double force = scene.bodies.force.to_host()[0].norm();
        impact.force       = std::max(impact.force, force);
        impact.approach    = std::max(impact.approach, approach(scene.bodies.position.to_host()));
        if (force > 0) { impact.duration += dt; }
    }
    return impact;
}

/// Undamped Hertz impact: docs/verification.md#hertz-impact.
inline Impact hertz_impact(double effective_young, double radius, double reduced_mass, double speed)
{
    const double k = 4.0 / 3.0 * effective_young * std::sqrt(radius);
    Impact       impact;
    impact.approach = std::pow(1.25 * reduced_mass * speed * speed / k, 0.4);
    impact.force    = k * std::pow(impact.approach, 1.5);
    impact.duration = 2.943275 * impact.approach / speed;
    return impact;
}

struct Material
{
    const char* name;
    double      young, poisson, density;
};

/// A ball thrown at the ground, in the xz plane.
struct Throw
{
    Material material;
    double   radius, friction, restitution;
    double   normal;         ///< m/s, towards the ground
    double   tangential = 0; ///< m/s
    double   spin       = 0; ///< rad/s, about y: the ball's lowest point moves along -x
};

/// Velocities after the impact.
struct Rebound
{
    double normal, tangential, spin;
};

/// Mass of the ball, kg.
inline double mass_of(const Throw& thrown)
{
    return 4.0 / 3.0 * std::numbers::pi * thrown.material.density * std::pow(thrown.radius, 3);
}

inline SolidNumbers numbers_of(const Throw& thrown)
{
    SolidNumbers numbers;
    numbers.young    = thrown.material.young;
    numbers.poisson  = thrown.material.poisson;
    numbers.friction = thrown.friction;
    numbers.zeta     = damping_ratio(thrown.restitution);
    return numbers;
}

/// Undamped impact on a rigid plane, which determines the step and the overlap.
inline Impact undamped(const Throw& thrown)
{
    const auto pair = properties(thrown.material.young, thrown.material.poisson, 1, 0, 0);
    return hertz_impact(pair.effective_young, thrown.radius, mass_of(thrown), thrown.normal);
}

/// Runs until body 0 is free again: a thousand steps in the duration of the undamped contact.
template<class Scene>
void run_through(Scene& scene, double duration)
{
    for (int part = 0; part < 20; ++part)
    {
        scene.run(duration / 1000, 500);
        if (scene.bodies.force.to_host()[0].norm() == 0) { return; }
    }
    ADD_FAILURE() << "still in contact";
}

template<class Scene, class Exec>
Rebound rebound_of(const Exec& exec, const Throw& thrown)
{
    SolidNumbers numbers = numbers_of(thrown);
    numbers.planes       = {ground};
    Solid ball           = solid_sphere(thrown.radius, thrown.material.density, {0, 0, thrown.radius});
    ball.velocity        = {thrown.tangential, 0, -thrown.normal};
    ball.spin            = {0, thrown.spin, 0};
    Scene scene(exec, {exact_sphere()}, {ball}, numbers);
    run_through(scene, undamped(thrown).duration);
    const Vec3<double> velocity = scene.bodies.velocity.to_host()[0];
    return {velocity[2], velocity[0], scene.bodies.angular_velocity.to_host()[0][1]};
}

} // namespace tread::test
