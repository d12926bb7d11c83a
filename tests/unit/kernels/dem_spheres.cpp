#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "dem_impact.hpp"

// Exact spheres compared with the closed forms of docs/verification.md#contact-of-bodies; the impacts of Chung and Ooi
// are in dem_chung_ooi.cpp.
namespace tread::test
{
namespace dem_spheres_test
{

template<class Exec>
class Spheres : public DemTest<Exec>
{
};
TYPED_TEST_SUITE(Spheres, Backends, BackendNames);

TYPED_TEST(Spheres, HeadOnCollisionIsHertz)
{
    constexpr double   radius = 0.2, contact = 0.032472, dt = contact / 2000;
    std::vector<Solid> pair{solid_sphere(radius, 2000, {-radius, 0, 0}), solid_sphere(radius, 2000, {radius, 0, 0})};
    pair[0].velocity = {1, 0, 0};
    pair[1].velocity = {-1, 0, 0};
    typename TestFixture::Scene scene(this->exec(), {exact_sphere()}, pair, {});
    const Impact impact = follow(scene, dt, 2100, [&](const auto& x) { return 2 * radius - (x[1] - x[0]).norm(); });
    // A1, E* = E / 2 (1 - nu^2). The step is a 2000th of the contact, and the largest values occur between steps.
    expect_close("largest force, N", impact.force, 7593.4, 1e-4);
    expect_close("largest approach, m", impact.approach, 0.022065, 1e-4);
    expect_close("duration, s", impact.duration, contact, 2e-3);
    const double rebound = scene.bodies.velocity.to_host()[1][0];
    expect_close("rebound, m/s", rebound, 1, 1e-6);
    EXPECT_LT(scene.sums().momentum.norm(), 1e-11);
    EXPECT_EQ(scene.sums().contact, 0);
}

TYPED_TEST(Spheres, ImpactOnAPlaneIsHertz)
{
    // A2, test 2: aluminium alloy at 0.2 m/s on a rigid plane
    constexpr double radius = 0.1, contact = 731.9e-6, dt = contact / 2000;
    SolidNumbers     numbers;
    numbers.young  = 7e10;
    numbers.planes = {ground};
    Solid ball     = solid_sphere(radius, 2699, {0, 0, radius});
    ball.velocity  = {0, 0, -0.2};
    typename TestFixture::Scene scene(this->exec(), {exact_sphere()}, {ball}, numbers);
    const Impact                impact = follow(scene, dt, 2100, [&](const auto& x) { return radius - x[0][2]; });
    expect_close("largest force, N", impact.force, 11365, 1e-3); // the source's digits
    expect_close("largest approach, m", impact.approach, 49.74e-6, 1e-3);
    expect_close("duration, s", impact.duration, contact, 2e-3);
    expect_close("rebound, m/s", scene.bodies.velocity.to_host()[0][2], 0.2, 1e-6);
}

TYPED_TEST(Spheres, RestitutionIsTheOneAskedFor)
{
    for (const double wanted : {0.9, 0.7, 0.5, 0.3, 0.1})
    {
        SolidNumbers numbers;
        numbers.zeta   = damping_ratio(wanted);
        numbers.planes = {ground};
        Solid ball     = solid_sphere(0.2, 2000, {0, 0, 0.2});
        ball.velocity  = {0, 0, -1};
        typename TestFixture::Scene scene(this->exec(), {exact_sphere()}, {ball}, numbers);
        scene.run(1e-5, 20000);
        const dem::BodySums sums = scene.sums();
        // A7: the closed form is exact, the step a 3000th of the contact
        expect_close("restitution", scene.bodies.velocity.to_host()[0][2], wanted, 1e-3);
        const double before = 0.5 * scene.bodies.mass.to_host()[0];
        EXPECT_NEAR(sums.kinetic + sums.total.restitution, before, 1e-3 * before);
    }
}

/// A ball at rest on the ground under its own weight.
struct Resting
{
    Solid  ball;
    double overlap; ///< m
};

Resting resting_ball(double radius, const SolidNumbers& numbers, double weight)
{
    Resting      found{solid_sphere(radius, 2500, {0, 0, radius}), 0};
    const double effective = numbers.young / (1 - numbers.poisson * numbers.poisson);
    found.overlap          = std::pow(0.75 * found.ball.mass * weight / (effective * std::sqrt(radius)), 2.0 / 3.0);
    found.ball.position[2] -= found.overlap;
    return found;
}

SolidNumbers on_slope(double tilt_degrees)
{
    SolidNumbers numbers;
    numbers.young    = 1e9;
    numbers.friction = 0.3;
    numbers.zeta     = 0.2;
    numbers.gravity  = 9.8 * Vec3<double>(std::sin(tilt_degrees * degree), 0, -std::cos(tilt_degrees * degree));
    numbers.planes   = {ground};
    return numbers;
}

TYPED_TEST(Spheres, SlidingEndsRolling)
{
    constexpr double radius = 0.05, dt = 5e-6;
    const auto       numbers = on_slope(0);
    Resting          resting = resting_ball(radius, numbers, 9.8);
    resting.ball.velocity    = {1, 0, 0};
    typename TestFixture::Scene scene(this->exec(), {exact_sphere()}, {resting.ball}, numbers);
    const double                before = scene.sums().kinetic;
    std::printf("overlap %.1e of the radius: what shortens the arm\n", resting.overlap / radius);
    scene.run(dt, 24000); // 0.12 s; sliding ends at 2 v / 7 mu g = 0.0972 s
    expect_close("velocity, m/s", scene.bodies.velocity.to_host()[0][0], 5.0 / 7, 1e-3);
    expect_close("spin, rad/s", scene.bodies.angular_velocity.to_host()[0][1], 5.0 / 7 / radius, 1e-3);
    expect_close("energy lost", 1 - scene.sums().kinetic / before, 2.0 / 7, 1e-3);
}

TYPED_TEST(Spheres, InclineRollsOrSlips)
{
    constexpr double radius = 0.05, dt = 5e-6, time = 0.1;
    for (const auto& [tilt, acceleration] :
         {std::array{10.0, 1.21554}, std::array{30.0, 3.5}, std::array{50.0, 5.61744}})
    {
        const auto                  numbers = on_slope(tilt);
        const Resting               resting = resting_ball(radius, numbers, 9.8 * std::cos(tilt * degree));
        typename TestFixture::Scene scene(this->exec(), {exact_sphere()}, {resting.ball}, numbers);
        scene.run(dt, 20000);
        // the contact loads its tangential spring first, over a millisecond
        expect_close("acceleration, m/s2", scene.bodies.velocity.to_host()[0][0] / time, acceleration, 2e-3);
    }
}

TYPED_TEST(Spheres, StackOfTenIsAsShortAsHertzSays)
{
    constexpr double radius = 0.01, weight = 9.8, young = 1e7, poisson = 0.25;
    SolidNumbers     numbers;
    numbers.young   = young;
    numbers.poisson = poisson;
    numbers.zeta    = 0.9;
    numbers.gravity = {0, 0, -weight};
    numbers.planes  = {ground};
    std::vector<Solid> stack;
    for (int i = 0; i < 10; ++i) { stack.push_back(solid_sphere(radius, 2650, {0, 0, (2 * i + 1) * radius})); }
    typename TestFixture::Scene scene(this->exec(), {exact_sphere()}, stack, numbers);
    scene.run(1e-4, 40000);

    const auto position = scene.bodies.position.to_host();
    const auto expected = [&](int above, bool wall)
    {
        const double load = above * stack[0].mass * weight;
        const auto   pair = properties(young, poisson, wall ? 1 : 2, 0, 0);
        return std::pow(0.75 * load / (pair.effective_young * std::sqrt(wall ? radius : 0.5 * radius)), 2.0 / 3.0);
    };
    expect_close("overlap on the ground, m", radius - position[0][2], expected(10, true), 1e-5);
    for (int i = 1; i < 10; ++i)
    {
        const auto at = static_cast<std::size_t>(i);
        expect_close("overlap, m", 2 * radius - (position[at][2] - position[at - 1][2]), expected(10 - i, false), 1e-5);
    }
    EXPECT_LT(scene.sums().kinetic, 1e-16);
}

TYPED_TEST(Spheres, StepFollowsTheImpactToCome)
{
    std::vector<Solid> pair{solid_sphere(0.2, 2000, {-0.2001, 0, 0}), solid_sphere(0.2, 2000, {0.2001, 0, 0})};
    pair[0].velocity = {1, 0, 0};
    pair[1].velocity = {-1, 0, 0};
    typename TestFixture::Scene scene(this->exec(), {exact_sphere()}, pair, {});
    scene.find(1e-3);
    expect_contacts(this->exec(), scene.pairs, scene.bodies.view(), scene.law(), Vec3<double>::Zero(), 1e-3);
    const double effective = 1e7 / 0.91 / 2, stiffness = 2 * effective * std::sqrt(0.1 * 0.022065); // A1
    expect_close("contact time, s", smallest_contact_time(this->exec(), scene.pairs, scene.bodies.view()),
                 std::sqrt(pair[0].mass / stiffness), 1e-4);
}

} // namespace dem_spheres_test
} // namespace tread::test
