#include <cmath>
#include <string>

#include <fmt/format.h>

#include "harness.hpp"

// Rolling resistance: a ball on slopes and on the level.
namespace rolling_test
{

using namespace tread;

template<class Exec>
class Rolling : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(Rolling, test::Backends, test::BackendNames);

constexpr double g = 9.81, radius = 0.05, mass = 1.3, young = 3e6, poisson = 0.3, mu_r = 0.1;

/// Depth (m) by which the ball's weight presses it into a floor (Hertz).
double depth_at_rest(double slope)
{
    return std::pow(0.75 * mass * g * std::cos(slope) * (1 - poisson * poisson) / (young * std::sqrt(radius)),
                    2.0 / 3.0);
}

/// A ball that touches a floor, with gravity inclined by the given slope: it sinks in as it starts.
std::string text(double slope, double speed, double rolling, double restitution, double duration)
{
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
generate  = {{ kind = "sphere", nodes = 162 }}
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
                       g * std::sin(slope), -g * std::cos(slope), young, poisson, restitution, rolling, 2 * radius,
                       mass, radius, speed, duration);
}

struct Course
{
    double speed;        ///< m/s, at the end
    double acceleration; ///< m/s2, mean of the last two thirds of the time
    double moved;        ///< m
    double spin;         ///< rad/s, at the end
    double lost;         ///< unaccounted energy, over the energy exchanged
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

/// Acceleration, m/s2, of a ball that rolls down: about the contact point, with r = R less the overlap below its
/// centre, its inertia is m r^2 + 2/5 m R^2, and mu_r R times the normal load resists. At r = R: 5/7 (g sin - mu_r g
/// cos).
double rolling_acceleration(double slope, double rolling)
{
    const double r = radius - depth_at_rest(slope);
    return g * r * (r * std::sin(slope) - rolling * radius * std::cos(slope)) / (r * r + 0.4 * radius * radius);
}

constexpr double steps = 5e-3; ///< tolerance: errors of contact, spring and steps are smaller

/// Slip ends at 2 v / (7 mu g) = 0.06 s, when the first oscillations of the contact have decayed.
TYPED_TEST(Rolling, BallOnTheLevelSlowsDown)
{
    constexpr double duration = 0.3;
    const double     expected = rolling_acceleration(0, mu_r), arm = radius - depth_at_rest(0);
    const Course     course = roll(this->exec(), text(0, 1, mu_r, 0.3, duration), duration);
    test::report("deceleration on the level, m/s2", course.acceleration, expected, steps * std::abs(expected), "steps");
    test::report("spin times r over speed", course.spin * arm / course.speed, 1, steps, "it rolls");
    test::report("energy unaccounted", course.lost, 0, 2e-3, "first order in dt");
    EXPECT_NEAR(course.acceleration, expected, steps * std::abs(expected));
    EXPECT_NEAR(course.spin * arm / course.speed, 1, steps);
    EXPECT_NEAR(course.lost, 0, 2e-3);
    const Course free = roll(this->exec(), text(0, 1, 0, 0.3, duration), duration);
    test::report("the same without rolling friction", free.acceleration, 0, steps * std::abs(expected), "steps");
    EXPECT_NEAR(free.acceleration, 0, steps * std::abs(expected));
}

/// Below atan(mu_r) the spring holds the ball, which turns by at most the yield angle: 4/9 F/(K mu_r R), with K = 3/2
/// F/d of a Hertz contact; above, it rolls.
TYPED_TEST(Rolling, BallStaysBelowTheAngleOfItsFrictionAndRollsAbove)
{
    constexpr double duration = 0.4, long_duration = 1.2; // the spring oscillates at 20 rad/s, damped by a third
    const double     angle = std::atan(mu_r), below = 0.9 * angle, above = 2 * angle;
    const Course     still = roll(this->exec(), text(below, 0, mu_r, 0.3, long_duration), long_duration);
    // Twice: a load applied suddenly stretches the spring to twice its rest value; a tenth for the rise time of the
    // load.
    const double most = 2.2 * depth_at_rest(below) / (3.375 * mu_r);
    test::report("moved in 1.2 s at 0.9 atan(mu_r), m", still.moved, 0, most, "the spring's stretch");
    test::report("speed at its end, m/s", still.speed, 0, 1e-4, "at rest");
    EXPECT_LE(std::abs(still.moved), most);
    EXPECT_LE(std::abs(still.speed), 1e-4);

    const double expected = rolling_acceleration(above, mu_r);
    const Course rolls    = roll(this->exec(), text(above, 0, mu_r, 0.3, duration), duration);
    test::report("acceleration at 2 atan(mu_r), m/s2", rolls.acceleration, expected, steps * expected, "steps");
    EXPECT_NEAR(rolls.acceleration, expected, steps * expected);
}

/// Without rolling resistance its arrays do not exist.
TYPED_TEST(Rolling, IsAbsentWhenOff)
{
    const auto bytes = [&](double rolling)
    {
        test::Experiment<TypeParam> experiment(this->exec(), text(0, 1, rolling, 1, 0.002));
        experiment.run();
        std::int64_t held = 0; // of this list or of the last: they are swapped
        for (const auto& [name, bytes_held] : this->counters.bytes())
        {
            if (name.ends_with("pair rolling moments")) { held += bytes_held; }
        }
        return held;
    };
    EXPECT_EQ(bytes(0), 0);
    EXPECT_GT(bytes(mu_r), 0);
}

} // namespace rolling_test
