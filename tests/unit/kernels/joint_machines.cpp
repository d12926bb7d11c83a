#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <vector>

#include "joint_scene.hpp"

// Machines of several joints: loops, rovers, and drift over many substeps.
namespace tread::test
{
namespace joint_machines_test
{

constexpr double pi = std::numbers::pi, g = 9.81;

template<class Exec>
class JointMachines : public BackendTest<Exec>
{
};
TYPED_TEST_SUITE(JointMachines, Backends, BackendNames);

template<class Exec>
class FullSizeJointMachines : public JointMachines<Exec>
{
};
TYPED_TEST_SUITE(FullSizeJointMachines, Backends, BackendNames);

/// Bars of a parallelogram that stands on its side of 0.5 m, and its joints.
std::vector<Solid> four_bars()
{
    const double rise = std::asin(0.6);
    return {rod(0.3, 1, {0.12, 0, 0.09}, -rise), rod(0.5, 1, {0.49, 0, 0.18}), rod(0.3, 1, {0.62, 0, 0.09}, -rise)};
}

std::vector<Tie> four_bar_ties(dem::JointKind inner)
{
    return {{dem::joint_revolute, {world, 0}, {0, 0, 0}},
            {inner, {0, 1}, {0.24, 0, 0.18}},
            {inner, {1, 2}, {0.74, 0, 0.18}},
            {dem::joint_revolute, {world, 2}, {0.5, 0, 0}}};
}

/// Two rods of 1 kg and 1 m, released when horizontal.
template<class Exec>
JointScene<Exec> double_pendulum(const Exec& exec)
{
    return JointScene<Exec>(exec, {rod(1, 1, {0.5, 0, 0}), rod(1, 1, {1.5, 0, 0})},
                            {{dem::joint_revolute, {world, 0}, {0, 0, 0}}, {dem::joint_revolute, {0, 1}, {1, 0, 0}}});
}

/// s, from the first to the third time that the centre of body 0 passes x = 0; NaN if it does not. `look` is called
/// after each substep.
template<class Exec, class Look>
double period_of(JointScene<Exec>& scene, double dt, const Look& look)
{
    std::vector<double> passages;
    double              last = scene.position(0)[0];
    for (int step = 1; passages.size() < 3 && step < 40000; ++step)
    {
        scene.run(dt, 1);
        look();
        const double next = scene.position(0)[0];
        if ((last > 0) != (next > 0)) { passages.push_back(dt * (step - 1 + last / (last - next))); }
        last = next;
    }
    return passages.size() == 3 ? passages[2] - passages[0] : std::numeric_limits<double>::quiet_NaN();
}

/// Direction of a rod that hangs at an angle from the vertical, positive towards +x.
Vec3<double> hanging(double angle) { return {std::sin(angle), 0, -std::cos(angle)}; }

// Two equal rods that hang swing in two modes. Small angles a, b: (4/3 a'' + b''/2) l + 3/2 g a = 0 and
// (a''/2 + b''/3) l + g b/2 = 0, so that w^2 l/g = 3 -+ 6/sqrt(7) and b/a = 3 g/(w^2 l) - 8/3.
TYPED_TEST(JointMachines, DoublePendulumSwingsInItsTwoModes)
{
    constexpr double dt = 1e-4, swing = 3e-4; // rad, of the upper rod
    for (const double sign : {-1.0, 1.0})
    {
        const double          square = 3 + sign * 6 / std::sqrt(7.0), shape = 3 / square - 8.0 / 3;
        const double          lower = shape * swing, expected = 2 * pi / std::sqrt(square * g);
        const Vec3<double>    knee = hanging(swing);
        JointScene<TypeParam> scene(
            this->exec(),
            {rod(1, 1, 0.5 * knee, 0.5 * pi - swing), rod(1, 1, knee + 0.5 * hanging(lower), 0.5 * pi - lower)},
            {{dem::joint_revolute, {world, 0}, {0, 0, 0}}, {dem::joint_revolute, {0, 1}, knee}});
        double     worst = 0;
        const auto angle = [&](std::int64_t b)
        {
            const Vec3<double> along = scene.orientation(b) * Vec3<double>::UnitX();
            return std::atan2(along[0], -along[2]);
        };
        const double period =
            period_of(scene, dt, [&] { worst = std::max(worst, std::abs(angle(1) - shape * angle(0))); });
        std::printf(
            "period %.9f s, expected %.9f, tolerance 2e-6 of it: 4 a^2 = 4e-7 of a finite swing, (w dt)^2 = 5e-7; "
            "angles off their ratio of %.6f by %.2e of the swing, expected 0, tolerance 1e-5: ten times these\n",
            period, expected, shape, worst / swing);
        EXPECT_NEAR(period, expected, 2e-6 * expected);
        EXPECT_LT(worst, 1e-5 * swing);
    }
}

/// Runs it for ten thousand substeps `parts` times.
template<class Exec>
void expect_double_pendulum_keeps_energy_and_joints(const Exec& exec, int parts)
{
    constexpr double dt    = 1e-5;
    auto             scene = double_pendulum(exec);
    const double     start = scene.energy(), scale = 2 * g; // J, fall of both centres to their lowest places
    double           worst = 0;
    for (int part = 0; part < parts; ++part)
    {
        scene.run(dt, 10000);
        worst = std::max(worst, std::abs(scene.energy() - start));
    }
    const auto [gap, angle] = scene.errors();
    // rates up to about 15 rad/s: an error of w^2 dt^2 / 2 in a substep, which the next one removes; velocities lag by
    // half a substep, in which the weights do up to 2 m g v dt / 2 = 1e-3 J
    std::printf(
        "after %d x 0.1 s in 1e4 substeps: gap %.2e m (tolerance 1e-7), misalignment %.2e rad (tolerance 1e-9: the "
        "motion is plane), change of energy %.2e J (tolerance 2e-4 of %.2f J)\n",
        parts, gap, angle, worst, scale);
    EXPECT_LT(gap, 1e-7);
    EXPECT_LT(angle, 1e-9);
    EXPECT_LT(worst, 2e-4 * scale);
    EXPECT_GT(gap, 0);
}

TYPED_TEST(JointMachines, DoublePendulumKeepsItsEnergyAndItsJointsOverAHundredThousandSubsteps)
{
    expect_double_pendulum_keeps_energy_and_joints(this->exec(), 10);
}

TYPED_TEST(FullSizeJointMachines, DoublePendulumKeepsItsEnergyAndItsJointsOverAMillionSubsteps)
{
    expect_double_pendulum_keeps_energy_and_joints(this->exec(), 100);
}

TYPED_TEST(JointMachines, ErrorOfAJointFallsWithTheSquareOfTheSubstep)
{
    double gap[2] = {};
    for (int i = 0; i < 2; ++i)
    {
        auto scene = double_pendulum(this->exec());
        scene.run(1e-3 / (1 << i), 1000 << i);
        gap[i] = scene.errors().first;
    }
    std::printf("gap %.3e m at 1e-3 s, %.3e at half of it: ratio %.3f, expected 4, tolerance 0.2: third-order terms\n",
                gap[0], gap[1], gap[0] / gap[1]);
    EXPECT_NEAR(gap[0] / gap[1], 4, 0.2);
}

// A chain that hangs at rest: each joint carries the weight of all links below it. Its 200 rows do not fit into the
// shared memory of a block.
TYPED_TEST(JointMachines, LinksOfALongChainCarryTheWeightBelowThem)
{
    constexpr int      links = 40;
    constexpr double   dt = 1e-3, mass = 2, length = 0.1, time = 0.1;
    std::vector<Solid> chain;
    std::vector<Tie>   ties;
    for (int k = 0; k < links; ++k)
    {
        chain.push_back(rod(length, mass, {0, 0, -(k + 0.5) * length}, 0.5 * pi));
        ties.push_back({dem::joint_revolute, {k - 1, k}, {0, 0, -k * length}}); // the world is -1
    }
    JointScene<TypeParam> scene(this->exec(), chain, ties);
    scene.run(dt, 100);
    double worst = 0;
    for (int k = 0; k < links; ++k)
    {
        const double load = scene.record(static_cast<std::size_t>(k)).impulse[2] / time;
        worst             = std::max(worst, std::abs(load - (links - k) * mass * g));
    }
    std::printf("a load off by %.2e N at most of %.0f N, tolerance 1e-8: rounding, amplified by the condition of 40 "
                "links in a row\n",
                worst, links * mass * g);
    EXPECT_LT(worst, 1e-8);
}

// Steady precession about a point: I1 W^2 cos t - I3 w3 W + m g l = 0 for the rate W, tilt t and spin w3.
TYPED_TEST(JointMachines, TopPrecessesSteadilyAboutASphericalJoint)
{
    constexpr double dt = 1e-4, mass = 1, lever = 0.1, across = 2e-3, along = 1e-3, rate = 2, tilt = pi / 6;
    const double     w3 =
        (mass * g * lever + (across + mass * lever * lever) * rate * rate * std::cos(tilt)) / (along * rate);
    const Quat         turn(Eigen::AngleAxisd(tilt, Vec3<double>::UnitY()));
    const Vec3<double> axis = turn * Vec3<double>::UnitZ();
    Solid              top;
    top.mass        = mass;
    top.inertia     = Vec3<double>(across, across, along).asDiagonal();
    top.orientation = turn;
    top.position    = lever * axis;
    top.spin        = rate * Vec3<double>::UnitZ() + (w3 - rate * std::cos(tilt)) * axis;
    top.velocity    = top.spin.cross(top.position);
    JointScene<TypeParam> scene(this->exec(), {top}, {{dem::joint_spherical, {world, 0}, Vec3<double>::Zero()}});
    scene.run(dt, 10000);
    const Vec3<double> place  = scene.position(0) / lever;
    const double       turned = std::atan2(place[1], place[0]);
    std::printf(
        "turned by %.6f rad in 1 s, expected %.6f, height %.6f, expected %.6f; tolerance 1e-3: w dt = 0.05 of its "
        "spin\n",
        turned, rate, place[2], std::cos(tilt));
    EXPECT_NEAR(turned, rate, 1e-3);
    EXPECT_NEAR(place[2], std::cos(tilt), 1e-3);
}

// Crank r, rod l: x = r cos a + sqrt(l^2 - r^2 sin^2 a) at every crank angle a.
TYPED_TEST(JointMachines, SliderFollowsItsCrank)
{
    constexpr double dt = 1e-4, r = 0.2, l = 0.6, speed = 10;
    Solid            slider;
    slider.mass     = 2;
    slider.inertia  = Mat3<double>::Identity() * 0.01;
    slider.position = {r + l, 0, 0};
    JointScene<TypeParam> scene(this->exec(), {rod(r, 1, {0.5 * r, 0, 0}), rod(l, 1, {r + 0.5 * l, 0, 0}), slider},
                                {{dem::joint_revolute, {world, 0}, {0, 0, 0}, {0, 1, 0}, motor(speed, 1e4)},
                                 {dem::joint_spherical, {0, 1}, {r, 0, 0}},
                                 {dem::joint_spherical, {1, 2}, {r + l, 0, 0}},
                                 {dem::joint_prismatic, {world, 2}, {r + l, 0, 0}, {1, 0, 0}}},
                                Vec3<double>::Zero());
    double                worst = 0;
    for (int part = 0; part < 100; ++part)
    {
        scene.run(dt, 100);
        const Vec3<double> out   = scene.orientation(0) * Vec3<double>::UnitX();
        const double       angle = std::atan2(-out[2], out[0]);
        const double       x     = r * std::cos(angle) + std::sqrt(l * l - std::pow(r * std::sin(angle), 2));
        worst                    = std::max(worst, std::abs(scene.position(2)[0] - x));
    }
    std::printf("slider off by %.2e m at most, tolerance 2e-6: w^2 dt^2 / 2 = 5e-7 of 0.8 m, for each of "
                "four joints\n",
                worst);
    EXPECT_LT(worst, 2e-6);
    EXPECT_NEAR(scene.spin(0)[1], speed, 1e-3);
}

// A plane four-bar of four revolute joints closes its loop twice: 20 rows for 18 freedoms, and yet one freedom. Rows
// that depend on others are skipped, and the bars move as with spherical joints.
TYPED_TEST(JointMachines, OverdeterminedFourBarMovesAsTheDeterminedOne)
{
    const std::vector<Solid> bars  = four_bars();
    const auto               moved = [&](dem::JointKind inner)
    {
        JointScene<TypeParam> scene(this->exec(), bars, four_bar_ties(inner));
        scene.run(1e-4, 1500);
        return scene.position(1);
    };
    const Vec3<double> over = moved(dem::joint_revolute), determined = moved(dem::joint_spherical);
    std::printf("coupler at %.9f %.9f, and %.9f %.9f; tolerance 1e-6: w^2 dt^2 / 2 = 1e-7 at 5 rad/s\n", over[0],
                over[2], determined[0], determined[2]);
    EXPECT_LT((over - determined).norm(), 1e-6);
    EXPECT_GT((over - bars[1].position).norm(), 0.01);
}

// A parallelogram that hangs: its coupler stays level and moves on a circle of the cranks' length l. Two cranks of m
// l^2/3 and a coupler of m on that circle have 5/3 m l^2 and hang by 2 m g l, so that w^2 = 6 g/(5 l), and from 60
// degrees the period is 4 K(sin 30)/w, with K = 1.6857503548 (Abramowitz and Stegun, table 17.1).
TYPED_TEST(JointMachines, ParallelogramSwingsAsOnePendulumWithALevelCoupler)
{
    constexpr double      dt = 1e-4, crank = 0.3, span = 0.5, start = pi / 3, elliptic = 1.6857503548;
    const Vec3<double>    arm      = crank * hanging(start), other(span, 0, 0);
    const double          expected = 4 * elliptic / std::sqrt(6 * g / (5 * crank));
    JointScene<TypeParam> scene(this->exec(),
                                {rod(crank, 1, 0.5 * arm, 0.5 * pi - start), rod(span, 1, arm + 0.5 * other),
                                 rod(crank, 1, 0.5 * arm + other, 0.5 * pi - start)},
                                {{dem::joint_revolute, {world, 0}, {0, 0, 0}},
                                 {dem::joint_revolute, {0, 1}, arm},
                                 {dem::joint_revolute, {1, 2}, arm + other},
                                 {dem::joint_revolute, {world, 2}, other}});
    double                tilt = 0, off = 0;
    const double          period = period_of(scene, dt,
                                             [&]
                                             {
                                        tilt =
                                            std::max(tilt, std::abs((scene.orientation(1) * Vec3<double>::UnitX())[2]));
                                        off = std::max(off, std::abs((scene.position(1) - 0.5 * other).norm() - crank));
                                    });
    std::printf("period %.9f s, expected %.9f, tolerance 1e-6 of it: (w dt)^2 = 4e-7; coupler tilted by %.2e rad, "
                "tolerance 1e-9: both cranks turn alike but for rounding; off its circle by %.2e m, tolerance 2e-7: "
                "w^2 dt^2 l/2 = 6e-8 at 6.3 rad/s, for each of three joints\n",
                period, expected, tilt, off);
    EXPECT_NEAR(period, expected, 1e-6 * expected);
    EXPECT_LT(tilt, 1e-9);
    EXPECT_LT(off, 2e-7);
}

TEST(JointLoops, FourRevoluteJointsOfAPlaneLoopAreFoundDependent)
{
    const std::vector<Solid> bars      = four_bars();
    const auto               dependent = [&](dem::JointKind inner)
    {
        std::vector<Vec3<double>> positions;
        std::vector<Quat>         orientations;
        for (const Solid& bar : bars)
        {
            positions.push_back(bar.position);
            orientations.push_back(bar.orientation);
        }
        return dem::dependent_joints(joints_of(bars, four_bar_ties(inner)), positions, orientations);
    };
    EXPECT_EQ(dependent(dem::joint_revolute), std::vector<std::size_t>{3});
    EXPECT_TRUE(dependent(dem::joint_spherical).empty());
}

// Two rockers of inertia J on a held chassis, of which one is loaded by a torque: with a differential both turn at
// tau / (2 J), in opposite directions.
TYPED_TEST(JointMachines, DifferentialTurnsRockersAgainstEachOther)
{
    constexpr double dt = 1e-4, inertia = 0.5, torque = 0.3, time = 0.5;
    Solid            chassis = rod(1, 10, {0, 0, 0});
    chassis.locked           = dem::lock_all;
    Solid rocker;
    rocker.mass    = 3;
    rocker.inertia = Mat3<double>::Identity() * inertia;
    Solid left = rocker, right = rocker;
    left.position  = {0, 0.5, 0};
    right.position = {0, -0.5, 0};
    JointScene<TypeParam>                scene(this->exec(), {chassis, left, right},
                                               {{dem::joint_revolute, {0, 1}, {0, 0.5, 0}},
                                                {dem::joint_revolute, {0, 2}, {0, -0.5, 0}},
                                                {dem::joint_differential, {world, world}, {0, 0, 0}, {0, 1, 0}, {}, {}, {0, 1}}});
    Array<TypeParam, std::int32_t>       run(this->exec(), "test runs"), first(this->exec(), "test run parts");
    Array<TypeParam, dem::ContactWrench> part(this->exec(), "test wrenches");
    run.assign({-1, 0, -1});
    first.assign({0, 1});
    part.assign({{Vec3<double>::Zero(), Vec3<double>(0, torque, 0), 0}});
    scene.run(dt, 5000, {run.data(), first.data(), part.data()});
    const double expected = torque * time / (2 * inertia), tie = scene.record(2).motor_impulse / time;
    std::printf("left %.9f rad/s, right %.9f, expected %.9f and its opposite; torque of the differential %.9f N m, "
                "expected %.9f; tolerance 1e-9: constant torque is exact\n",
                scene.spin(1)[1], scene.spin(2)[1], expected, tie, -0.5 * torque);
    EXPECT_NEAR(scene.spin(1)[1], expected, 1e-9);
    EXPECT_NEAR(scene.spin(2)[1], -expected, 1e-9);
    EXPECT_NEAR(tie, -0.5 * torque, 1e-9);
    EXPECT_LT(scene.record(2).misalignment, 1e-9);
}

// A rover of four wheels hangs from four springs. The chassis lies d before the pivots, in the middle of the rockers of
// length 2 a: half of its moment m g d comes from each rocker through the differential, so that a front wheel carries
// w + m g / 4 + m g d / (4 a) and a rear wheel w + m g / 4 - m g d / (4 a), with w its own weight and its rocker's
// half.
TYPED_TEST(JointMachines, RoverOnFourSpringsSharesItsLoadByTheDifferential)
{
    constexpr double dt = 1e-4, chassis = 80, rocker = 6, wheel = 5, a = 0.5, side = 0.6, forward = 0.1, up = 3;
    constexpr double stiffness = 2e4, damping = 600;
    const auto       body = [](double mass, double size, const Vec3<double>& place)
    {
        Solid solid;
        solid.mass     = mass;
        solid.inertia  = Mat3<double>::Identity() * (mass * size * size);
        solid.position = place;
        return solid;
    };
    std::vector<Solid> solids = {body(chassis, 0.4, {forward, 0, 0}), body(rocker, 0.3, {0, side, 0}),
                                 body(rocker, 0.3, {0, -side, 0})};
    std::vector<Tie>   ties   = {{dem::joint_revolute, {0, 1}, {0, side, 0}},
                                 {dem::joint_revolute, {0, 2}, {0, -side, 0}},
                                 {dem::joint_differential, {world, world}, {0, 0, 0}, {0, 1, 0}, {}, {}, {0, 1}}};
    for (int w = 0; w < 4; ++w)
    {
        const Vec3<double> hub(w % 2 == 0 ? a : -a, w < 2 ? side : -side, -0.2);
        solids.push_back(body(wheel, 0.1, hub));
        ties.push_back({dem::joint_revolute, {1 + w / 2, 3 + w}, hub});
    }
    for (int w = 0; w < 4; ++w)
    {
        const Vec3<double> hub = solids[static_cast<std::size_t>(3 + w)].position, top = hub + Vec3<double>(0, 0, up);
        ties.push_back({dem::joint_spring, {world, 3 + w}, top, {0, 0, 1}, spring(stiffness, damping, up), hub});
    }
    JointScene<TypeParam> scene(this->exec(), solids, ties);
    scene.run(dt, 60000);
    scene.clear_records();
    scene.run(dt, 100);
    const double own = (wheel + 0.5 * rocker) * g, share = 0.25 * chassis * g, more = 0.25 * chassis * g * forward / a;
    for (std::size_t w = 0; w < 4; ++w)
    {
        const double load     = scene.record(7 + w).impulse[2] / (100 * dt);
        const double expected = own + share + (w % 2 == 0 ? more : -more);
        std::printf(
            "wheel %zu carries %.4f N, expected %.4f, tolerance 0.5 %%: the springs give %.1f mm, which moves the "
            "loads' lines\n",
            w, load, expected, 1e3 * expected / stiffness);
        EXPECT_NEAR(load, expected, 5e-3 * expected);
    }
}

} // namespace joint_machines_test
} // namespace tread::test
