#include <cmath>
#include <string>

#include <fmt/format.h>

#include "harness.hpp"

// Resistance to rolling: a ball on slopes and on the level.
namespace
{

using namespace tread;

template<class Exec>
class Rolling : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(Rolling, test::Backends, test::BackendNames);

constexpr double g = 9.81, radius = 0.05, mass = 1.3, young = 3e6, poisson = 0.3, mu_r = 0.1;

/// A ball at the overlap that its weight needs, on a floor that gravity makes a slope of the given angle.
std::string text(double slope, double speed, double rolling, double restitution, double duration)
{
    const double down  = g * std::cos(slope);
    const double stiff = young / (1 - poisson * poisson);
    const double depth = std::pow(0.75 * mass * down / (stiff * std::sqrt(radius)), 2.0 / 3.0);
    return fmt::format(R"(
title = "rolling"
[domain]
size    = [4.0, 1.0, 1.0]
gravity = [{}, 0.0, {}]
walls   = {{ x = "open", y = "open" }}
[time]
dt       = 1e-3
substeps = 10
[[material]]
name    = "steel"
model   = "elastic"
density = 2500.0
young   = {}
poisson = {}
[[contact]]
between          = ["steel", "wall"]
friction         = 0.5
restitution      = {}
rolling_friction = {}
[[shape]]
name      = "ball"
generate  = {{ kind = "sphere", nodes = 2562 }}
[[body]]
name     = "ball"
shape    = "ball"
material = "steel"
diameter = {}
mass     = {}
position = [1.0, 0.5, {}]
velocity = [{}, 0.0, 0.0]
[[phase]]
name     = "roll"
duration = {}
)",
                       g * std::sin(slope), -down, young, poisson, restitution, rolling, 2 * radius, mass,
                       radius - depth, speed, duration);
}

struct Course
{
    double speed;        ///< m/s, at the end
    double acceleration; ///< m/s2, mean of the last two thirds of the time
    double moved;        ///< m
    double spin;         ///< rad/s, at the end
    double lost;         ///< of the energy that changed hands, unaccounted
};

template<class Exec>
Course roll(const Exec& exec, const std::string& scene, double duration)
{
    test::Experiment<Exec> experiment(exec, scene);
    double                 early = 0, early_speed = 0;
    experiment.run(
        [&](double time)
        {
            if (early > 0 || time < duration / 3) { return; }
            early       = time;
            early_speed = experiment.simulation().named_bodies()[0].velocity[0];
        });
    const auto body   = experiment.simulation().named_bodies()[0];
    auto&      ledger = experiment.simulation().ledger();
    ledger.energy(experiment.simulation().census());
    return {body.velocity[0], (body.velocity[0] - early_speed) / (experiment.time() - early), body.position[0] - 1,
            body.angular_velocity[1], ledger.errors().energy};
}

/// Slip ends at 2 v / (7 mu g) = 0.06 s; after that the moment mu_r R m g slows the ball at 5/7 mu_r g: about the point
/// of contact its inertia is 7/5 m R^2. Tolerance 3 %: the ball rolls on nodes 7 % of a radius apart.
TYPED_TEST(Rolling, BallOnTheLevelSlowsDown)
{
    constexpr double duration = 0.3, expected = -5.0 / 7.0 * mu_r * g;
    const Course     course = roll(this->exec(), text(0, 1, mu_r, 1, duration), duration);
    test::report("deceleration on the level, m/s2", course.acceleration, expected, 0.03 * std::abs(expected), "nodes");
    test::report("spin times radius over speed", course.spin * radius / course.speed, 1, 0.01, "it rolls");
    test::report("energy unaccounted", course.lost, 0, 2e-3, "first order in dt");
    EXPECT_NEAR(course.acceleration, expected, 0.03 * std::abs(expected));
    EXPECT_NEAR(course.spin * radius / course.speed, 1, 0.01);
    EXPECT_NEAR(course.lost, 0, 2e-3);
    const Course free = roll(this->exec(), text(0, 1, 0, 1, duration), duration);
    test::report("the same without rolling friction", free.acceleration, 0, 0.03 * std::abs(expected), "nodes");
    EXPECT_NEAR(free.acceleration, 0, 0.03 * std::abs(expected));
}

/// Below atan(mu_r) the spring holds the ball, turned by at most what it yields at: 4/9 F/(K mu_r R), and K = 3/2 F/d
/// of a Hertz contact; above, it rolls at 5/7 (g sin - mu_r g cos).
TYPED_TEST(Rolling, BallStaysBelowTheAngleOfItsFrictionAndRollsAbove)
{
    constexpr double duration = 0.4, long_duration = 1.2; // the spring swings at 20 rad/s, damped by a third
    const double     angle = std::atan(mu_r), below = 0.9 * angle, above = 2 * angle;
    const Course     still = roll(this->exec(), text(below, 0, mu_r, 0.3, long_duration), long_duration);
    const double depth = std::pow(0.75 * mass * g * (1 - poisson * poisson) / (young * std::sqrt(radius)), 2.0 / 3.0);
    // Twice: let go at once, the spring is stretched to twice its rest; K of nodes is within a tenth of Hertz's.
    const double most = 2.2 * depth / (3.375 * mu_r);
    test::report("moved in 1.2 s at 0.9 atan(mu_r), m", still.moved, 0, most, "the spring's stretch");
    test::report("speed at its end, m/s", still.speed, 0, 1e-4, "at rest");
    EXPECT_LE(std::abs(still.moved), most);
    EXPECT_LE(std::abs(still.speed), 1e-4);

    const double expected = 5.0 / 7.0 * g * (std::sin(above) - mu_r * std::cos(above));
    const Course rolls    = roll(this->exec(), text(above, 0, mu_r, 1, duration), duration);
    test::report("acceleration at 2 atan(mu_r), m/s2", rolls.acceleration, expected, 0.03 * expected, "nodes");
    EXPECT_NEAR(rolls.acceleration, expected, 0.03 * expected);
}

/// Off, it has no arrays.
TYPED_TEST(Rolling, IsAbsentWhenOff)
{
    const auto bytes = [&](double rolling)
    {
        test::Experiment<TypeParam> experiment(this->exec(), text(0, 1, rolling, 1, 0.002));
        experiment.run();
        const auto& held = this->counters.bytes();
        const auto  row  = held.find("pair rolling moments");
        return row == held.end() ? 0 : row->second;
    };
    EXPECT_EQ(bytes(0), 0);
    EXPECT_GT(bytes(mu_r), 0);
}

} // namespace
