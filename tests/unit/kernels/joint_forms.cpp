#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "joint_scene.hpp"

// Joints against closed forms: one or two bodies, whose motion or load follows by hand.
namespace tread::test
{
namespace joint_forms_test
{

constexpr double pi = std::numbers::pi, g = 9.81;

template<class Exec>
class JointForms : public BackendTest<Exec>
{
};
TYPED_TEST_SUITE(JointForms, Backends, BackendNames);

/// Mean of a record's impulse over a time.
Vec3<double> mean(const Vec3<double>& impulse, double time) { return impulse / time; }

Solid block(double mass, const Vec3<double>& position)
{
    Solid solid;
    solid.mass     = mass;
    solid.inertia  = Vec3<double>(0.03, 0.02, 0.05).asDiagonal();
    solid.position = position;
    return solid;
}

// A rod of mass m and length l that swings through 90 degrees about its end: period 4 sqrt(2 l / (3 g)) K(sin 45), with
// K = 1.8540746773 (Abramowitz and Stegun, table 17.1), and at the lowest point a load of m g (1 + 3/2) on the pivot.
TYPED_TEST(JointForms, RodSwingsWithTheEllipticPeriodAndLoadsItsPivot)
{
    constexpr double      dt = 1e-4, length = 1, mass = 2, elliptic = 1.8540746773;
    JointScene<TypeParam> scene(this->exec(), {rod(length, mass, {0.5 * length, 0, 0})},
                                {{dem::joint_revolute, {world, 0}, Vec3<double>::Zero()}});
    const double          expected = 4 * std::sqrt(2 * length / (3 * g)) * elliptic;
    std::vector<double>   crossings;
    double                load = 0, last = 0.5 * length;
    for (int step = 1; crossings.size() < 3 && step < 40000; ++step)
    {
        scene.clear_records();
        scene.run(dt, 1);
        const double next = scene.position(0)[0];
        if ((last > 0) != (next > 0))
        {
            crossings.push_back(dt * (step - 1 + last / (last - next)));
            if (crossings.size() == 1) { load = mean(scene.record(0).impulse, dt)[2]; }
        }
        last = next;
    }
    ASSERT_EQ(crossings.size(), 3u);
    const double period = crossings[2] - crossings[0];
    std::printf(
        "period %.8f s, expected %.8f, tolerance 1e-6 of it: second-order scheme, (w dt)^2 = 1e-7; load %.5f N, "
        "expected %.5f, tolerance 1e-4 of it: the last substep ends up to dt from the lowest point\n",
        period, expected, load, 2.5 * mass * g);
    EXPECT_NEAR(period, expected, 1e-6 * expected);
    EXPECT_NEAR(load, 2.5 * mass * g, 1e-4 * 2.5 * mass * g);
}

// A block on a rail at 30 degrees: a = g sin 30, and the rail carries m g cos 30 across and no moment.
TYPED_TEST(JointForms, BlockSlidesDownAPrismaticRail)
{
    constexpr double      dt = 1e-3, mass = 3, slope = pi / 6;
    constexpr int         steps = 1000;
    const Vec3<double>    rail(std::cos(slope), 0, -std::sin(slope)), across(std::sin(slope), 0, std::cos(slope));
    JointScene<TypeParam> scene(this->exec(), {block(mass, {1, 2, 3})},
                                {{dem::joint_prismatic, {world, 0}, {1, 2, 3}, rail}});
    scene.run(dt, steps);
    const double           time = dt * steps, way = 0.5 * g * std::sin(slope) * time * (time + dt); // symplectic Euler
    const dem::JointRecord record = scene.record(0);
    const Vec3<double>     force  = mean(record.impulse, time);
    std::printf("way %.12f m, expected %.12f, force across %.12f N, expected %.12f, tolerance 1e-10: rounding over %d "
                "substeps\n",
                (scene.position(0) - Vec3<double>(1, 2, 3)).dot(rail), way, force.dot(across),
                mass * g * std::cos(slope), steps);
    EXPECT_NEAR((scene.position(0) - Vec3<double>(1, 2, 3)).dot(rail), way, 1e-10);
    EXPECT_NEAR(force.dot(across), mass * g * std::cos(slope), 1e-10);
    EXPECT_NEAR(force.dot(rail), 0, 1e-10);
    EXPECT_LT(record.angular_impulse.norm(), 1e-10);
}

// Two blocks welded to each other and to the world: the root carries both weights and their moment.
TYPED_TEST(JointForms, CantileverOfTwoWeldedBlocksLoadsItsRoot)
{
    constexpr double      dt = 1e-3, mass = 2;
    constexpr int         steps = 500;
    JointScene<TypeParam> scene(this->exec(), {block(mass, {1, 0, 0}), block(mass, {3, 0, 0})},
                                {{dem::joint_fixed, {world, 0}, {0, 0, 0}}, {dem::joint_fixed, {0, 1}, {2, 0, 0}}});
    scene.run(dt, steps);
    const dem::JointRecord root = scene.record(0), middle = scene.record(1);
    const double           time = dt * steps;
    std::printf("root %.12f N and %.12f N m, expected %.12f and %.12f, tolerance 1e-9: rounding over %d substeps\n",
                mean(root.impulse, time)[2], mean(root.angular_impulse, time)[1], 2 * mass * g, -4 * mass * g, steps);
    EXPECT_NEAR(mean(root.impulse, time)[2], 2 * mass * g, 1e-9);
    EXPECT_NEAR(mean(root.angular_impulse, time)[1], -mass * g * (1 + 3), 1e-9); // r x F: x times z is -y
    EXPECT_NEAR(mean(middle.impulse, time)[2], mass * g, 1e-9);
    EXPECT_NEAR(mean(middle.angular_impulse, time)[1], -mass * g * 1, 1e-9);
    EXPECT_NEAR(scene.position(1)[0], 3, 1e-12);
}

// A disc whose motor gives at most tau: w = tau t / J up to its speed, then that speed; the work is J w^2 / 2.
TYPED_TEST(JointForms, MotorSpeedsUpAtItsLargestTorqueAndThenHoldsItsSpeed)
{
    constexpr double      dt = 1e-3, torque = 0.4, speed = 5, inertia = 0.02;
    const dem::Joint      numbers = motor(speed, torque);
    JointScene<TypeParam> scene(this->exec(), {block(1, {0, 0, 0})},
                                {{dem::joint_revolute, {world, 0}, Vec3<double>::Zero(), {0, 1, 0}, numbers}});
    const double          time = inertia * speed / torque; // 0.25 s
    scene.run(dt, 100);
    const double halfway = scene.spin(0)[1];
    scene.run(dt, 900);
    const double reached = scene.spin(0)[1], impulse = scene.record(0).motor_impulse;
    const double work = scene.sums().total.holding_work;
    std::printf(
        "after 0.1 s %.9f rad/s, expected %.9f (tolerance 1e-9, constant torque is exact); after 1 s %.9f, "
        "expected %g and impulse %.9f, expected %.9f (tolerance 1e-5: a motor may miss 1e-6 of its speed); work "
        "%.6f J, expected %.6f, tolerance 1e-5\n",
        halfway, 0.1 * torque / inertia, reached, speed, impulse, inertia * speed, work, 0.5 * inertia * speed * speed);
    EXPECT_NEAR(halfway, 0.1 * torque / inertia, 1e-9);
    EXPECT_GT(1.0, time);
    EXPECT_NEAR(reached, speed, 1e-5);
    EXPECT_NEAR(impulse, inertia * speed, 1e-5);
    EXPECT_NEAR(work, 0.5 * inertia * speed * speed, 1e-5);
}

// A motor with a gain k turns a disc as w = w0 (1 - exp(-k t / J)).
TYPED_TEST(JointForms, MotorWithAGainReachesItsSpeedExponentially)
{
    constexpr double      dt = 1e-4, speed = 5, inertia = 0.02, gain = 0.1, time = 0.2;
    JointScene<TypeParam> scene(this->exec(), {block(1, {0, 0, 0})},
                                {{dem::joint_revolute, {world, 0}, {0, 0, 0}, {0, 1, 0}, motor(speed, 10, gain)}});
    scene.run(dt, 2000);
    const double expected = speed * (1 - std::exp(-gain * time / inertia)), found = scene.spin(0)[1];
    std::printf("%.6f rad/s, expected %.6f, tolerance 1e-3 of the speed: implicit Euler, k dt / J = 5e-4\n", found,
                expected);
    EXPECT_NEAR(found, expected, 1e-3 * speed);
}

// A torsional spring with a damper, released at rest a: a exp(-d t) (cos w t + d / w sin w t).
TYPED_TEST(JointForms, TorsionalSpringSwingsWithItsDamping)
{
    constexpr double      dt = 1e-5, inertia = 0.02, stiffness = 2, damping = 0.04, start = 0.3, time = 1;
    JointScene<TypeParam> scene(
        this->exec(), {block(1, {0, 0, 0})},
        {{dem::joint_revolute, {world, 0}, {0, 0, 0}, {0, 1, 0}, spring(stiffness, damping, start)}});
    scene.run(dt, 100000);
    const double d = damping / (2 * inertia), w = std::sqrt(stiffness / inertia - d * d);
    const double expected = start - start * std::exp(-d * time) * (std::cos(w * time) + d / w * std::sin(w * time));
    const double found    = scene.record(0).coordinate;
    std::printf("angle %.7f rad, expected %.7f, tolerance 1e-4: implicit Euler damps by w^2 dt / 2 = 5e-4 1/s\n", found,
                expected);
    EXPECT_NEAR(found, expected, 1e-4);
}

// A ball on a spring between two points: it hangs lower by m g / k, and the damper has taken m g (m g / k) / 2.
TYPED_TEST(JointForms, BallHangsFromASpringAtItsWeight)
{
    constexpr double      dt = 1e-4, mass = 2, stiffness = 500, length = 1;
    JointScene<TypeParam> scene(
        this->exec(), {block(mass, {0, 0, -length})},
        {{dem::joint_spring, {world, 0}, {0, 0, 0}, {0, 0, 1}, spring(stiffness, 40, length), {0, 0, -length}}});
    scene.run(dt, 40000);
    const double drop = mass * g / stiffness;
    std::printf("drop %.9f m, expected %.9f, tolerance 1e-9: the motion has decayed by exp(-40)\n",
                -scene.position(0)[2] - length, drop);
    EXPECT_NEAR(-scene.position(0)[2] - length, drop, 1e-9);
    EXPECT_NEAR(scene.sums().total.holding_work, -mass * g * drop, 1e-4); // at rest: all of the fall's work
}

// A rod falls on its stop at 30 degrees below the horizontal and stays: the stop's moment is m g l/2 cos 30.
TYPED_TEST(JointForms, RodRestsOnItsStop)
{
    constexpr double      dt = 1e-4, mass = 2, length = 1, stop = pi / 6;
    JointScene<TypeParam> scene(this->exec(), {rod(length, mass, {0.5 * length, 0, 0})},
                                {{dem::joint_revolute, {world, 0}, {0, 0, 0}, {0, 1, 0}, limits(-stop, stop)}});
    scene.run(dt, 10000);
    const double beyond = std::abs(scene.record(0).excess);
    scene.clear_records();
    scene.run(dt, 1000);
    const double moment   = mean(scene.record(0).angular_impulse, 1000 * dt)[1];
    const double expected = -0.5 * mass * g * length * std::cos(stop);
    std::printf("angle %.12f rad, expected %.12f; %.3g rad beyond it when it struck, expected 0; moment %.9f N m, "
                "expected %.9f; tolerance 1e-9: rounding, as the axis of the stop does not turn\n",
                scene.record(0).coordinate, stop, beyond, moment, expected);
    EXPECT_LT(beyond, 1e-9);
    EXPECT_NEAR(scene.record(0).coordinate, stop, 1e-9);
    EXPECT_NEAR(moment, expected, 1e-9);
}

// A disc whose rotation is prescribed gives way to no stop: its record has the way beyond it, with the sign of the end.
TYPED_TEST(JointForms, ADiscThatIsTurnedPastItsStopRecordsTheWayBeyond)
{
    constexpr double dt = 1e-3, low = -0.1, high = 0.2, turned = 0.499; // rad at the start of the last substep
    for (const double spin : {1.0, -1.0})
    {
        Solid disc  = block(1, {0, 0, 0});
        disc.spin   = {0, spin, 0};
        disc.locked = dem::lock_all;
        JointScene<TypeParam> scene(this->exec(), {disc},
                                    {{dem::joint_revolute, {world, 0}, {0, 0, 0}, {0, 1, 0}, limits(low, high)}});
        scene.run(dt, 150);
        if (spin > 0) { EXPECT_EQ(scene.record(0).excess, 0) << "0.15 rad are within the limits"; }
        scene.run(dt, 350);
        const double found = scene.record(0).excess, expected = spin > 0 ? turned - high : -turned - low;
        std::printf("%.12f rad beyond, expected %.12f; tolerance 1e-9: rounding over 500 substeps\n", found, expected);
        EXPECT_NEAR(found, expected, 1e-9);
    }
}

// A motor that runs against a stop gives its largest torque, and the stop takes it.
TYPED_TEST(JointForms, MotorAgainstAStopGivesItsLargestTorque)
{
    dem::Joint numbers = motor(3, 0.5);
    numbers.parts |= dem::joint_has_limits;
    numbers.low  = -1;
    numbers.high = 0.2;
    JointScene<TypeParam> scene(this->exec(), {block(1, {0, 0, 0})},
                                {{dem::joint_revolute, {world, 0}, Vec3<double>::Zero(), {0, 1, 0}, numbers}});
    scene.run(1e-3, 500);
    scene.clear_records();
    scene.run(1e-3, 100);
    const dem::JointRecord record = scene.record(0);
    std::printf("angle %.12f rad, expected 0.2; motor %.9f N m, expected 0.5; both on the body %.3g, expected 0; "
                "tolerance 1e-9: rounding\n",
                record.coordinate, record.motor_impulse / 0.1, record.angular_impulse[1] / 0.1);
    EXPECT_NEAR(record.coordinate, 0.2, 1e-9);
    EXPECT_NEAR(record.motor_impulse / 0.1, 0.5, 1e-9);
    EXPECT_NEAR(record.angular_impulse[1] / 0.1, 0, 1e-9);
}

} // namespace joint_forms_test
} // namespace tread::test
