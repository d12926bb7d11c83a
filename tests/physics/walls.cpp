#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "harness.hpp"

// Every kind of wall with blocks and beds that rest on it, slide over it or leave it.
namespace walls_test
{

using namespace tread;

template<class Exec>
class WallsOfSand : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(WallsOfSand, test::Backends, test::BackendNames);

constexpr double gravity = 9.81;

/// An elastic block, 0.4 m x 0.2 m and one cell thick, on a floor tilted by `degrees`; x points downslope. It starts
/// without stress and oscillates, which would make its base slip and stick in turn; FLIP's filter damps that.
std::string block_text(double degrees, const std::string& walls, double duration)
{
    const double angle = degrees * std::numbers::pi / 180;
    return fmt::format(R"(
title = "block on a slope"
[domain]
size    = [2.4, 0.05, 0.6]
gravity = [{}, 0.0, {}]
walls   = {{ x = "open", y = "slip", top = "open", {} }}
[grid]
spacing = 0.05
[numerics]
precision = "double"
transfer = "flip"
[[material]]
name = "block"
model = "elastic"
density = 1800.0
young = 1.0e6
poisson = 0.2
[[terrain]]
material = "block"
region = {{ box = [[0.2, 0.0, 0.0], [0.6, 0.05, 0.2]] }}
[[phase]]
name = "slide"
duration = {}
)",
                       gravity * std::sin(angle), -gravity * std::cos(angle), walls, duration);
}

/// Mean velocity (m/s) and position (m) of the sand's mass.
struct Motion
{
    double       time;
    Vec3<double> position, velocity;
};

template<class Experiment>
Motion motion(Experiment& experiment)
{
    const solver::SandCensus now = experiment.simulation().census().sand;
    return {experiment.time(), now.moment / now.mass, now.momentum / now.mass};
}

/// Acceleration (m/s2) between a fifth of the run, when the block's stress has built up, and its end.
template<class Exec>
Vec3<double> acceleration(const Exec& exec, double degrees, const std::string& walls, double duration)
{
    test::Experiment<Exec> slide(exec, block_text(degrees, walls, duration));
    Motion                 early{};
    const auto             look = [&](double time)
    {
        if (early.time == 0 && time >= 0.2 * duration) { early = motion(slide); }
    };
    slide.run(look);
    const Motion late = motion(slide);
    return (late.velocity - early.velocity) / (late.time - early.time);
}

/// docs/verification.md#block-on-an-incline, #layer-on-a-slope: a sliding block has a = g (sin - mu cos).
TYPED_TEST(WallsOfSand, BlockSlidesByCoulombsLaw)
{
    for (const double degrees : {20.0, 30.0, 45.0})
    {
        const double angle    = degrees * std::numbers::pi / 180;
        const double expected = gravity * (std::sin(angle) - 0.3 * std::cos(angle));
        const double measured = acceleration(this->exec(), degrees, "bottom = \"frictional\", friction = 0.3", 0.5)[0];
        test::report(fmt::format("acceleration at {} degrees in m/s2", degrees), measured, expected, 0.01 * expected,
                     "docs/verification.md#layer-on-a-slope: 1 %");
        EXPECT_NEAR(measured, expected, 0.01 * expected);
    }
}

/// The work of friction is its force times the displacement, and the ledger accounts for it as friction.
TYPED_TEST(WallsOfSand, FrictionIsInTheLedger)
{
    const double                slope = std::numbers::pi / 4;
    test::Experiment<TypeParam> slide(this->exec(), block_text(45, "bottom = \"frictional\", friction = 0.3", 0.5));
    const Motion                start = motion(slide);
    slide.run();
    const Motion            end = motion(slide);
    const auto              now = slide.simulation().census();
    const solver::EnergyRow row = slide.simulation().ledger().energy(now);
    const double work = 0.3 * now.sand.mass * gravity * std::cos(slope) * (end.position[0] - start.position[0]);
    test::report("friction in J", row.friction, work, 0.03 * work,
                 "force 1 %, and its foot shears back by up to a cell's strain");
    EXPECT_NEAR(row.friction, work, 0.03 * work);
    const double error = slide.simulation().ledger().balance(now).impulse_error;
    test::report("impulse error over weight x time", error, 0, 1e-10,
                 "fp64 rounding (verification docs/verification.md#momentum-balance)");
    EXPECT_LT(error, 1e-10);
}

/// Displacement (m) of the block's top when its own weight shears it slowly: rho g sin H^2 / (2 G). Its mean moves two
/// thirds as far, overshoots to twice that if the weight is applied at once, and bending adds to it: up to two of
/// these.
double top_shear(double degrees)
{
    return 1800 * gravity * std::sin(degrees * std::numbers::pi / 180) * 0.2 * 0.2 / (2 * 1e6 / (2 * 1.2));
}

/// docs/verification.md#block-on-an-incline: below atan 0.3 = 16.7 degrees it stays, except for the shear due to its
/// weight.
TYPED_TEST(WallsOfSand, BlockSticksBelowTheAngleOfFriction)
{
    test::Experiment<TypeParam> stick(this->exec(), block_text(10, "bottom = \"frictional\", friction = 0.3", 1.0));
    const Motion                start = motion(stick);
    Motion                      middle{};
    const auto                  look = [&](double time)
    {
        if (middle.time == 0 && time >= 0.5) { middle = motion(stick); }
    };
    stick.run(look);
    const Motion end  = motion(stick);
    const double most = 2 * top_shear(10), moved = end.position[0] - start.position[0];
    const double crept = end.position[0] - middle.position[0];
    test::report("displacement in m", moved, 0.5 * most, 0.5 * most,
                 "shear under its own weight, swinging, and bending");
    EXPECT_NEAR(moved, 0.5 * most, 0.5 * most);
    const double free = 0.5 * gravity * std::sin(std::numbers::pi / 18) * 0.25;
    test::report("creep from 0.5 s to 1 s in m", crept, 0, 1e-3 * free,
                 "a thousandth of free sliding from rest; it still swings");
    EXPECT_LT(std::abs(crept), 1e-3 * free);
}

/// slip: no force along the wall, weight across it; fixed: holds at 45 degrees; open: has no effect.
TYPED_TEST(WallsOfSand, SlipFixedAndOpenFloors)
{
    const double       along = gravity * std::sin(std::numbers::pi / 4);
    const Vec3<double> slip  = acceleration(this->exec(), 45, "bottom = \"slip\"", 0.4);
    test::report("slip floor, along it, m/s2", slip[0], along, 1e-9 * along, "no force along it at all");
    EXPECT_NEAR(slip[0], along, 1e-9 * along);
    test::Experiment<TypeParam> held(this->exec(), block_text(45, "bottom = \"fixed\"", 0.4));
    const Motion                start = motion(held);
    held.run();
    const double moved = motion(held).position[0] - start.position[0], most = 2 * top_shear(45);
    test::report("fixed floor, along it, m", moved, 0.5 * most, 0.5 * most,
                 "shear under its own weight, swinging, and bending");
    EXPECT_NEAR(moved, 0.5 * most, 0.5 * most);
    const Vec3<double> open = acceleration(this->exec(), 45, "bottom = \"open\"", 0.1);
    test::report("open floor, across it, m/s2", open[2], -along, 1e-9 * along, "free fall");
    EXPECT_NEAR(open[2], -along, 1e-9 * along);
}

/// A floor without adhesion releases the sand: a block thrown off it flies.
TYPED_TEST(WallsOfSand, BlockLeavesTheFloor)
{
    for (const std::string floor : {"slip", "frictional"})
    {
        test::Experiment<TypeParam> fly(this->exec(), block_text(0, "bottom = \"" + floor + "\"", 0.2));
        auto&                       points = fly.simulation().sand().points();
        points.stress.fill_zero();
        auto       v = points.velocity.to_host();
        const auto n = v.size() / 3;
        std::fill(v.begin() + static_cast<std::ptrdiff_t>(2 * n), v.end(), 2.0);
        points.velocity.assign(v);
        const Motion start = motion(fly);
        fly.run();
        const Motion end = motion(fly);
        const double t = fly.time(), expected = 2 * t - 0.5 * gravity * t * t;
        const double tolerance = gravity * t * fly.dt();
        test::report("rise in m off a " + floor + " floor", end.position[2] - start.position[2], expected, tolerance,
                     "symplectic Euler: g t dt");
        EXPECT_NEAR(end.position[2] - start.position[2], expected, tolerance);
    }
}

/// Cohesionless sand 0.2 m high on one wall, one cell thick and as long as its box; gravity points away from that wall
/// if `away` > 0 and towards it otherwise.
std::string heap_text(const std::string& walls, const Vec3<double>& pull, double duration)
{
    return fmt::format(R"(
title = "sand on one wall"
[domain]
size    = [0.6, 0.05, 0.6]
gravity = [{}, 0.0, {}]
walls   = {{ y = "slip", {} }}
[grid]
spacing = 0.05
[numerics]
precision = "double"
[[material]]
name = "sand"
model = "mohr-coulomb"
density = 1600.0
young = 1.0e6
poisson = 0.3
friction_angle_deg = 35.0
[[terrain]]
material = "sand"
region = {{ box = [[0.0, 0.0, 0.0], [0.2, 0.05, 0.2]] }}
[[phase]]
name = "go"
duration = {}
)",
                       pull[0], pull[2], walls, duration);
}

/// Momentum along `pull` over that of free fall.
template<class Exec>
double share_of_free_fall(const Exec& exec, const std::string& walls, const Vec3<double>& pull)
{
    constexpr double       duration = 0.05;
    test::Experiment<Exec> fall(exec, heap_text(walls, pull, duration));
    fall.simulation().sand().points().stress.fill_zero();
    fall.run();
    return motion(fall).velocity.dot(pull) / (pull.squaredNorm() * fall.time());
}

/// Cohesionless sand pulled off a rough wall, upwards or sideways, leaves it without a force. A fixed wall retains the
/// sand beside it.
TYPED_TEST(WallsOfSand, SandLeavesARoughWallAndNotAFixedOne)
{
    struct Case
    {
        const char*  what;
        const char*  walls;
        Vec3<double> pull;
    };
    for (const Case& c : {Case{"up from the floor", "x = \"open\", top = \"open\", bottom = ", {0, 0, gravity}},
                          Case{"sideways", "bottom = \"open\", top = \"open\", x = ", {gravity, 0, 0}}})
    {
        const double rough = share_of_free_fall(this->exec(), std::string(c.walls) + "\"rough\"", c.pull);
        const double fixed = share_of_free_fall(this->exec(), std::string(c.walls) + "\"fixed\"", c.pull);
        test::report(fmt::format("share of free fall, rough wall, {}", c.what), rough, 1, 1e-12, "no force: rounding");
        test::report(fmt::format("share of free fall, fixed wall, {}", c.what), fixed, 1 - 0.125, 0.125,
                     "half of the four cells' lowest or more stays");
        EXPECT_NEAR(rough, 1, 1e-12);
        EXPECT_LT(fixed, 0.95);
    }
}

/// Under load a rough floor acts as a fixed one: a bed keeps the stress of its weight, and a block does not slide where
/// Coulomb friction of 0.3 would let it.
TYPED_TEST(WallsOfSand, RoughFloorHoldsWhatPressesOnIt)
{
    const auto stress = [&](const std::string& floor)
    {
        const std::string           walls = "x = \"slip\", top = \"open\", bottom = \"" + floor + "\"";
        test::Experiment<TypeParam> bed(this->exec(), heap_text(walls, {0, 0, -gravity}, 0.2));
        bed.run();
        return bed.simulation().sand().points().stress.to_host();
    };
    const auto rough = stress("rough"), fixed = stress("fixed");
    double     off = 0, largest = 0;
    for (std::size_t i = 0; i < rough.size(); ++i)
    {
        off     = std::max(off, std::abs(rough[i] - fixed[i]));
        largest = std::max(largest, std::abs(fixed[i]));
    }
    test::report("stress on a rough floor beside a fixed one, over the largest", off / largest, 0, 1e-9,
                 "both hold all the time: the same sums");
    EXPECT_LT(off, 1e-9 * largest);
    EXPECT_GT(largest, 0.5 * 1600 * gravity * 0.2);

    test::Experiment<TypeParam> block(this->exec(), block_text(20, "bottom = \"rough\"", 0.5));
    const Motion                start = motion(block);
    block.run();
    const double moved = motion(block).position[0] - start.position[0], most = 2 * top_shear(20);
    test::report("displacement of a block at 20 degrees on a rough floor in m", moved, 0.5 * most, 0.5 * most,
                 "shear under its own weight, swinging, and bending; with a friction of 0.3 it would be 74 mm");
    EXPECT_NEAR(moved, 0.5 * most, 0.5 * most);
}

/// A bed of 0.2 m x 0.2 m against three walls that meet in a corner; `up` inverts the vertical direction.
std::string corner_text(int cells, bool up)
{
    const double size = 0.05 * cells;
    return fmt::format(R"(
title = "corner"
[domain]
size    = [{0}, {0}, {0}]
gravity = [{1}, {1}, {1}]
walls   = {{ x = "slip", y = "frictional", bottom = "fixed", top = "fixed", friction = 0.2 }}
[grid]
spacing = 0.05
[time]
dt = 5e-4
[numerics]
precision = "double"
transfer = "flip"
[[material]]
name = "sand"
model = "elastic"
density = 1800.0
young = 1.0e6
poisson = 0.3
[[terrain]]
material = "sand"
region = {{ box = [[{2}, {2}, {2}], [{3}, {3}, {3}]] }}
[[phase]]
name = "lean"
duration = 0.05
)",
                       size, up ? 4.0 : -4.0, up ? size - 0.2 : 0.0, up ? size : 0.2);
}

/// High walls act like low ones, wherever the walls lie within their pages of four nodes.
TYPED_TEST(WallsOfSand, HighWallsMirrorLowOnes)
{
    const auto lean = [&](int cells, bool up)
    {
        test::Experiment<TypeParam> bed(this->exec(), corner_text(cells, up));
        bed.simulation().sand().points().stress.fill_zero();
        const Motion start = motion(bed);
        bed.run();
        return Vec3<double>(motion(bed).position - start.position);
    };
    const Vec3<double> low = lean(8, false);
    EXPECT_LT(low.maxCoeff(), -1e-6);
    for (int cells = 8; cells < 12; ++cells)
    {
        const double difference = (lean(cells, true) + low).norm() / low.norm();
        test::report(fmt::format("high against low walls, {} cells", cells), difference, 0, 1e-9,
                     "fp64 rounding over 100 steps");
        EXPECT_LT(difference, 1e-9);
    }
}

} // namespace walls_test
