#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "harness.hpp"

// Bodies that are turned at the start, and ground that slopes: directions and signs.
namespace oriented_test
{

using namespace tread;

template<class Exec>
class Oriented : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(Oriented, test::Backends, test::BackendNames);

constexpr double radius = 0.1, spin = 5, slip = 0.2;

const std::string steered_text = fmt::format(R"(
title = "a steered wheel in the air"
[domain]
size    = [2.0, 1.0, 1.0]
gravity = [0.0, 0.0, 0.0]
walls   = {{ x = "open", y = "open", bottom = "open" }}
[time]
dt = 1e-3
[[material]]
name    = "steel"
model   = "elastic"
density = 7800.0
young   = 1.0e9
poisson = 0.3
[[shape]]
name      = "wheel"
generate  = {{ kind = "wheel", radius = {}, width = 0.08, wall_thickness = 0.03, grousers = 5, grouser_height = 0.01 }}
sdf_cells = 48
node_spacing = 0.01
[[body]]
name       = "wheel"
shape      = "wheel"
material   = "steel"
mass       = 5.0
position   = [0.5, 0.5, 0.5]
yaw_deg    = 25.0
camber_deg = -10.0
lock       = ["y", "z", "roll", "yaw"]
[[phase]]
name     = "drive"
duration = 0.4
drive    = {{ body = "wheel", angular_velocity = {}, slip = {} }}
)",
                                             radius, spin, slip);

/// A steered wheel turns about its own axle, and the prescribed slip moves it along x.
TYPED_TEST(Oriented, ASteeredWheelTurnsAboutItsAxleAndMovesAlongX)
{
    test::Experiment<TypeParam> run(this->exec(), steered_text);
    run.run();
    const auto   wheel = run.simulation().named_bodies()[0];
    const double yaw = 25 * std::numbers::pi / 180, camber = -10 * std::numbers::pi / 180;
    // Rz(yaw) Rx(camber) y
    const Vec3<double> axle(-std::sin(yaw) * std::cos(camber), std::cos(yaw) * std::cos(camber), std::sin(camber));
    const double       speed = (1 - slip) * spin * radius;
    test::report("axle off the one at the start", (wheel.axle - axle).norm(), 0, 1e-12, "rounding of 400 rotations");
    test::report("speed along x, m/s", wheel.velocity[0], speed, 1e-12, "prescribed");
    EXPECT_LT((wheel.axle - axle).norm(), 1e-12);
    EXPECT_LT((wheel.angular_velocity - spin * axle).norm(), 1e-12 * spin);
    EXPECT_LT((wheel.velocity - Vec3<double>(speed, 0, 0)).norm(), 1e-12);
    EXPECT_NEAR(wheel.position[0], 0.5 + 0.4 * speed, 1e-9);
}

constexpr double g = 9.81, friction = 0.2, slope = 30, direction = 40;

const std::string block_text = fmt::format(R"(
title = "a block on a slope"
[domain]
size                = [2.0, 2.0, 0.5]
gravity_size        = {}
slope_deg           = {}
slope_direction_deg = {}
walls               = {{ x = "open", y = "open" }}
[time]
dt = 5e-4
[[material]]
name    = "steel"
model   = "elastic"
density = 2500.0
young   = 1.0e8
poisson = 0.3
[[contact]]
between     = ["steel", "wall"]
friction    = {}
restitution = 0.1
[[shape]]
name     = "block"
generate = {{ kind = "box", size = [0.2, 0.2, 0.05] }}
[[body]]
name     = "block"
shape    = "block"
material = "steel"
mass     = 5.0
yaw_deg  = {}
position = [1.0, 1.0, 0.025]
[[phase]]
name     = "slide"
duration = 0.3
)",
                                           g, slope, direction, friction, direction);

/// Coulomb's block: down the slope, against the direction in which the ground rises, with g (sin a - mu cos a).
TYPED_TEST(Oriented, ABlockSlidesDownTheSlope)
{
    test::Experiment<TypeParam> run(this->exec(), block_text);
    double                      early          = 0;
    Vec3<double>                early_velocity = Vec3<double>::Zero();
    run.run(
        [&](double time)
        {
            if (early > 0 || time < 0.1) { return; }
            early          = time;
            early_velocity = run.simulation().named_bodies()[0].velocity;
        });
    const double       angle = slope * std::numbers::pi / 180, way = direction * std::numbers::pi / 180;
    const double       expected  = g * (std::sin(angle) - friction * std::cos(angle));
    const Vec3<double> gained    = run.simulation().named_bodies()[0].velocity - early_velocity;
    const double       found     = gained.norm() / (run.time() - early);
    constexpr double   tolerance = 1e-3;
    test::report("acceleration, m/s2", found, expected, tolerance * expected,
                 "the block lands on its springs at the start and rocks, by less and less");
    EXPECT_NEAR(found, expected, tolerance * expected);
    const Vec3<double> downhill(-std::cos(way), -std::sin(way), 0);
    test::report("its direction off downhill", (gained.normalized() - downhill).norm(), 0, tolerance, "as above");
    EXPECT_LT((gained.normalized() - downhill).norm(), tolerance);
}

} // namespace oriented_test
