#include <cmath>
#include <cstdio>
#include <vector>

#include "dem_scene.hpp"

namespace tread::test
{
namespace dem_friction_test
{

template<class Exec>
class BodyFriction : public DemTest<Exec>
{
};
TYPED_TEST_SUITE(BodyFriction, Backends, BackendNames);

const dem::Plane ground{{0, 0, 1}, 0.0, false};

/// A 10 cm cube of 2 kg flat on the ground, its lowest nodes `depth` inside.
Solid cube_on_ground(double depth)
{
    Solid cube;
    cube.mass     = 2;
    cube.inertia  = Mat3<double>::Identity() * (2 * 0.01 / 6);
    cube.position = {0, 0, 0.05 - depth};
    return cube;
}

SolidShape cube_shape() { return box_solid(Vec3<double>::Constant(0.05), 8, 40); }

SolidNumbers on_ground(double tilt_degrees)
{
    const double tilt = tilt_degrees * std::numbers::pi / 180;
    SolidNumbers numbers;
    numbers.friction = 0.3;
    numbers.zeta     = 0.2;
    numbers.gravity  = 9.8 * Vec3<double>(std::sin(tilt), 0, -std::cos(tilt));
    numbers.planes   = {ground};
    return numbers;
}

TYPED_TEST(BodyFriction, SlidingSphereEndsRolling)
{
    constexpr double r = 0.05, speed = 1, dt = 2e-5;
    SolidNumbers     numbers = on_ground(0);
    numbers.young            = 3e6;
    numbers.zeta             = 0.01;
    Solid        ball        = solid_sphere(r, 2500, {0, 0, r});
    const double effective   = numbers.young / (1 - numbers.poisson * numbers.poisson);
    const double depth       = std::pow(0.75 * ball.mass * 9.8 / (effective * std::sqrt(r)), 2.0 / 3.0);
    ball.position[2] -= depth;
    ball.velocity[0] = speed;
    typename TestFixture::Scene scene(this->exec(), {unit_sphere(4, 64)}, {ball}, numbers);
    const double                before = scene.sums().kinetic;

    std::printf("tolerance 1 %%: the overlap, %.1e of r, shortens the lever arm, and the ball rolls on nodes 7 %% of r "
                "apart, whose damping resists\n",
                depth / r);
    const auto report = [&](const char* when, double v, double spin)
    {
        const double found_v    = scene.bodies.velocity.to_host()[0][0];
        const double found_spin = scene.bodies.angular_velocity.to_host()[0][1];
        std::printf("%s: v %.5f m/s, expected %.5f; r omega %.5f m/s, expected %.5f\n", when, found_v, v,
                    r * found_spin, r * spin);
        EXPECT_NEAR(found_v, v, 0.01 * v);
        EXPECT_NEAR(found_spin, spin, 0.01 * spin);
    };
    scene.run(dt, 2500); // 0.05 s
    report("sliding", speed - 0.3 * 9.8 * 0.05, 2.5 * 0.3 * 9.8 * 0.05 / r);
    scene.run(dt, 3500); // 0.12 s, slip ends at 0.0972 s
    report("rolling", 5 * speed / 7, 5 * speed / 7 / r);
    const double lost = 1 - scene.sums().kinetic / before;
    std::printf("energy lost %.4f, expected %.4f\n", lost, 2.0 / 7.0);
    EXPECT_NEAR(lost, 2.0 / 7.0, 0.01);
}

TYPED_TEST(BodyFriction, CubeSlidesDownASteepInclineAndSticksOnAGentleOne)
{
    constexpr double            dt = 1e-5;
    typename TestFixture::Scene steep(this->exec(), {cube_shape()}, {cube_on_ground(1e-6)}, on_ground(30));
    steep.run(dt, 10000);
    const double early = steep.bodies.velocity.to_host()[0][0];
    steep.run(dt, 10000);
    const double found    = (steep.bodies.velocity.to_host()[0][0] - early) / 0.1;
    const double expected = 9.8 * (std::sin(std::numbers::pi / 6) - 0.3 * std::cos(std::numbers::pi / 6));
    std::printf("acceleration %.5f, expected %.5f m/s2, tolerance 0.5 %% (settling bounce)\n", found, expected);
    EXPECT_NEAR(found, expected, 0.005 * expected);

    typename TestFixture::Scene gentle(this->exec(), {cube_shape()}, {cube_on_ground(1e-6)}, on_ground(10));
    gentle.run(dt, 20000);
    const Vec3<double> settled = gentle.bodies.position.to_host()[0];
    gentle.run(dt, 20000);
    const Vec3<double> later = gentle.bodies.position.to_host()[0];
    std::printf("creep at 10 degrees in 0.2 s: %.1e m, limit 1e-9 m; speed %.1e m/s\n", (later - settled).norm(),
                gentle.bodies.velocity.to_host()[0].norm());
    EXPECT_LT((later - settled).norm(), 1e-9);
    EXPECT_LT(std::abs(settled[0]), 1e-5);
}

TYPED_TEST(BodyFriction, SpinningCubeComesToRest)
{
    constexpr double dt   = 1e-5;
    Solid            cube = cube_on_ground(1e-6);
    cube.spin             = {0, 0, 5};
    typename TestFixture::Scene scene(this->exec(), {cube_shape()}, {cube}, on_ground(0));
    scene.run(dt, 30000);
    const Vec3<double> spin = scene.bodies.angular_velocity.to_host()[0];
    std::printf("spin after 0.3 s %.1e rad/s (5 at the start), limit 1e-6\n", spin.norm());
    EXPECT_LT(spin.norm(), 1e-6);
    EXPECT_LT(scene.bodies.velocity.to_host()[0].norm(), 1e-7);
    const dem::BodySums sums = scene.sums();
    EXPECT_NEAR(sums.total.wall_impulse[2], 2 * 9.8 * 0.3, 1e-4);
    EXPECT_GT(sums.total.friction, 0);
}

TYPED_TEST(BodyFriction, SlipWallsHaveNone)
{
    SolidNumbers numbers   = on_ground(30);
    numbers.planes[0].slip = true;
    typename TestFixture::Scene scene(this->exec(), {cube_shape()}, {cube_on_ground(1e-6)}, numbers);
    scene.run(1e-5, 2000);
    EXPECT_NEAR(scene.bodies.velocity.to_host()[0][0], 9.8 * 0.5 * 0.02, 1e-9);
    EXPECT_EQ(scene.sums().total.friction, 0);
}

/// A single patch, moved as on a test bench.
struct Bench
{
    dem::PairLaw law   = dem::pair_law({1e7, 8e6, 1e6, 0.0}, {1.0, 1e-3}, 10.0, 1.0);
    dem::Patch   patch = dem::no_patch();

    dem::Friction move(const Vec3<double>& normal, double stiffness, const Vec3<double>& velocity, double dt)
    {
        const dem::PatchState state{normal, 1.0, stiffness, 1e-4, velocity, 0.0, 0.0};
        return dem::update_patch(law, state, patch, dt);
    }
};

TEST(Patch, NoClosedCycleOfLoadAndShearMakesEnergy)
{
    // docs/verification.md#closed-cycles-of-friction: shear at high stiffness, unload to half of it, shear back until
    // the force vanishes
    const Vec3<double> up(0, 0, 1), sideways(1, 0, 0);
    Bench              bench;
    double             put_in = 0;
    const auto         shear  = [&](double stiffness, double step)
    {
        const Vec3<double> old = bench.patch.tangential;
        bench.move(up, stiffness, step * sideways, 1.0);
        put_in -= 0.5 * (old + bench.patch.tangential).dot(step * sideways);
    };
    for (int cycle = 0; cycle < 100; ++cycle)
    {
        for (int i = 0; i < 50; ++i) { shear(2000, 1e-5); }
        bench.move(up, 1000, Vec3<double>::Zero(), 1.0);
        EXPECT_GT(put_in, 0);
        while (bench.patch.tangential[0] < 0) { shear(1000, -1e-5); }
        EXPECT_GT(put_in, 0);
        bench.patch.tangential = Vec3<double>::Zero();
    }
    const double stored = 100 * 0.5 * bench.law.shear_ratio * 2000 * 5e-4 * 5e-4;
    std::printf("kept %.6f of the energy put in, expected 0.5 (docs/verification.md#closed-cycles-of-friction), "
                "tolerance 1e-9\n",
                put_in / stored);
    EXPECT_NEAR(put_in / stored, 0.5, 1e-9);
}

TEST(Patch, TurnsWithThePair)
{
    Bench bench;
    bench.move({0, 0, 1}, 1000, {1e-4, 0, 0}, 1.0);
    const double  length = bench.patch.tangential.norm();
    constexpr int steps  = 10000;
    for (int i = 1; i <= steps; ++i)
    {
        const double angle = 2.5 * std::numbers::pi * i / steps;
        bench.move({std::sin(angle), 0, std::cos(angle)}, 1000, Vec3<double>::Zero(), 1e-4);
    }
    // a quarter turn about y (and one whole) takes -x to z
    EXPECT_NEAR(bench.patch.tangential.norm() / length, 1, 1e-10);
    EXPECT_NEAR(bench.patch.tangential[2] / length, 1, 1e-10);
}

TEST(Patch, SlidingIsCappedAndPaidFor)
{
    Bench bench;
    bench.law.friction = 0.3;
    dem::Friction friction{};
    double        lost = 0;
    for (int i = 0; i < 1000; ++i)
    {
        friction = bench.move({0, 0, 1}, 1000, {1e-3, 0, 0}, 1.0);
        lost += friction.lost;
    }
    EXPECT_NEAR(friction.force.norm(), 0.3, 1e-12);
    EXPECT_NEAR(lost + friction.energy, 0.3 * 1.0, 1e-3);
}

} // namespace dem_friction_test
} // namespace tread::test
