#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "dem_scene.hpp"

namespace tread::test
{
namespace
{

template<class Exec>
class RigidBody : public DemTest<Exec>
{
};
TYPED_TEST_SUITE(RigidBody, Backends, BackendNames);

/// The box of docs/verification.md#torque-free-box.
Solid asymmetric_box()
{
    Solid box;
    box.inertia = Vec3<double>(0.13 / 12, 0.10 / 12, 0.05 / 12).asDiagonal();
    return box;
}

const std::vector<SolidShape>& any_shape()
{
    static const std::vector<SolidShape> shapes = {unit_sphere(0, 12)};
    return shapes;
}

Quat some_orientation() { return Quat(Eigen::AngleAxisd(0.7, Vec3<double>(1, 2, -2).normalized())); }

TYPED_TEST(RigidBody, TorqueFreeBoxFlipsOnTimeAndKeepsItsMomentum)
{
    constexpr double dt = 1e-4, length = 10,
                     expected_interval = 1.378374; // 2 K(k)/lambda, docs/verification.md#torque-free-box
    Solid box                          = asymmetric_box();
    box.orientation                    = some_orientation();
    box.spin                           = box.orientation * Vec3<double>(1, 10, 0);
    typename TestFixture::Scene scene(this->exec(), any_shape(), {box}, {});
    const dem::BodySums         start = scene.sums();

    std::vector<double> flips;
    double              last = 10;
    for (int step = 1; step <= static_cast<int>(length / dt); ++step)
    {
        scene.move(dt);
        const Quat   q    = read(this->exec(), scene.bodies.orientation.data());
        const double next = (q.conjugate() * read(this->exec(), scene.bodies.angular_velocity.data()))[1];
        if (last * next < 0) { flips.push_back(dt * (step - 1 + last / (last - next))); }
        last = next;
    }
    const dem::BodySums end          = scene.sums();
    const double        drift        = end.kinetic / start.kinetic - 1;
    const double        turned       = (end.spin - start.spin).norm() / start.spin.norm();
    const double        length_error = std::abs(read(this->exec(), scene.bodies.orientation.data()).norm() - 1);
    std::printf("energy drift %.2e, momentum error %.2e (tolerance 1e-6, verification "
                "docs/verification.md#torque-free-box), |q| - 1 %.1e\n",
                drift, turned, length_error);
    EXPECT_NEAR(start.kinetic, 0.422083333, 1e-8);
    EXPECT_LT(std::abs(drift), 1e-6);
    EXPECT_LT(turned, 1e-6);
    EXPECT_LT(length_error, 1e-12);
    ASSERT_EQ(flips.size(), 7u);
    for (std::size_t i = 1; i < flips.size(); ++i)
    {
        std::printf("flip %zu after %.6f s, expected %.6f, tolerance 1e-4 of it (second-order scheme)\n", i,
                    flips[i] - flips[i - 1], expected_interval);
        EXPECT_NEAR(flips[i] - flips[i - 1], expected_interval, 1e-4 * expected_interval);
    }
}

TYPED_TEST(RigidBody, FliesAParabola)
{
    constexpr double dt    = 1e-3;
    constexpr int    steps = 500;
    SolidNumbers     numbers;
    numbers.gravity = {0.5, 0, -9.81};
    Solid body;
    body.mass     = 3;
    body.velocity = {2, -1, 4};
    typename TestFixture::Scene scene(this->exec(), any_shape(), {body}, numbers);
    scene.run(dt, steps);
    // the parabola of symplectic Euler: v t + g t (t + dt)/2; the remaining error is rounding
    const double       t        = dt * steps;
    const Vec3<double> expected = body.velocity * t + 0.5 * t * (t + dt) * numbers.gravity;
    const Vec3<double> found    = read(this->exec(), scene.bodies.position.data());
    EXPECT_LT((found - expected).norm(), 1e-12);
}

TYPED_TEST(RigidBody, LockedFreedomsKeepTheirVelocity)
{
    constexpr double dt     = 1e-3;
    constexpr int    steps  = 1000;
    Solid            driven = asymmetric_box();
    driven.orientation      = some_orientation();
    driven.locked           = dem::lock_x | dem::lock_roll | dem::lock_pitch | dem::lock_yaw;
    driven.velocity         = {0.3, 0, 0};
    driven.spin             = {0, 2.5, 0};
    Solid held              = asymmetric_box();
    held.locked             = dem::lock_all;
    Solid rolling           = driven;
    rolling.locked          = dem::lock_roll | dem::lock_yaw;
    rolling.spin            = Vec3<double>::Zero();
    typename TestFixture::Scene          scene(this->exec(), any_shape(), {driven, held, rolling}, {});
    const Vec3<double>                   force(1, 2, 3), torque(0.01, 0.02, -0.03);
    Array<TypeParam, std::int32_t>       run(this->exec(), "test runs"), first(this->exec(), "test run parts");
    Array<TypeParam, dem::ContactWrench> part(this->exec(), "test wrenches");
    run.assign({0, 1, 2});
    first.assign({0, 1, 2, 4}); // the third's in two parts
    part.assign({{force, torque, 0}, {force, torque, 0}, {0.25 * force, 2 * torque, 0}, {0.75 * force, -torque, 0}});
    for (int step = 0; step < steps; ++step) { scene.move(dt, 0, {run.data(), first.data(), part.data()}); }
    const auto position = scene.bodies.position.to_host(), velocity = scene.bodies.velocity.to_host();
    const auto spin        = scene.bodies.angular_velocity.to_host();
    const auto orientation = scene.bodies.orientation.to_host();
    const auto totals      = scene.totals.to_host();

    EXPECT_EQ(velocity[0][0], 0.3);
    EXPECT_NEAR(velocity[0][2], 3.0, 1e-12);
    EXPECT_EQ(spin[0], Vec3<double>(0, 2.5, 0));
    const Quat turned = Quat(Eigen::AngleAxisd(2.5, Vec3<double>::UnitY())) * driven.orientation;
    EXPECT_LT(turned.angularDistance(orientation[0]), 1e-12);
    EXPECT_EQ(position[1], Vec3<double>::Zero());
    EXPECT_EQ(velocity[1], Vec3<double>::Zero());
    EXPECT_LT(orientation[1].angularDistance(Quat::Identity()), 1e-15);
    EXPECT_LT((totals[1].holding_impulse + force).norm(), 1e-12);

    // about a fixed world axis J_yy is constant: omega_y = T_y t / J_yy
    const Mat3<double> rotation = driven.orientation.toRotationMatrix();
    const double       about_y  = (rotation * driven.inertia * rotation.transpose())(1, 1);
    EXPECT_EQ(spin[2][0], 0);
    EXPECT_EQ(spin[2][2], 0);
    EXPECT_NEAR(spin[2][1], torque[1] / about_y, 1e-10);
}

/// A named body, a rock whose contacts bear the substep, and one whose contacts are nine times too stiff for its mass.
TYPED_TEST(RigidBody, ScaledInertiaYieldsLessAndIsAccountedFor)
{
    constexpr double dt = 1e-3, bearable = 400, factor = 9; // s, 1/s2
    SolidNumbers     numbers;
    numbers.gravity = {0, 0, -3.72};
    Solid rock;
    rock.mass    = 2;
    rock.inertia = 0.3 * Mat3<double>::Identity();
    typename TestFixture::Scene           scene(this->exec(), any_shape(), {rock, rock, rock}, numbers);
    const Vec3<double>                    force(1, 2, 3), torque(0.01, 0.02, -0.03);
    const double                          stiff = factor * bearable * rock.mass;
    Array<TypeParam, std::int32_t>        run(this->exec(), "test runs"), first(this->exec(), "test run parts");
    Array<TypeParam, dem::ContactWrench>  part(this->exec(), "test wrenches");
    Array<TypeParam, dem::ContactImpulse> named(this->exec(), "test impulses", 1);
    Array<TypeParam, double>              factor_now(this->exec(), "test factors");
    run.assign({0, 1, 2});
    first.assign({0, 1, 2, 3});
    part.assign({{force, torque, stiff}, {force, torque, 0.9 * bearable * rock.mass}, {force, torque, stiff}});
    named.fill_zero();
    factor_now.assign({1, 1, 1});
    dem::BodyStep<TypeParam> step = scene.step(dt, 0, {run.data(), first.data(), part.data()});
    step.named                    = {named.data(), 1};
    step.motion.scaling           = {factor_now.data(), bearable};
    move_bodies(this->exec(), step);

    const auto         velocity = scene.bodies.velocity.to_host(), spin = scene.bodies.angular_velocity.to_host();
    const auto         totals    = scene.totals.to_host();
    const Vec3<double> acting    = force + rock.mass * numbers.gravity;
    const double       factors[] = {1, 1, factor};
    for (std::size_t b = 0; b < 3; ++b)
    {
        const Vec3<double> moves = dt / (factors[b] * rock.mass) * acting, turns = dt / (factors[b] * 0.3) * torque;
        EXPECT_LT((velocity[b] - moves).norm(), 1e-14) << b;
        EXPECT_LT((spin[b] - turns).norm(), 1e-14) << b;
        EXPECT_LT((totals[b].holding_impulse + dt * acting - rock.mass * moves).norm(), 1e-14) << b;
        const double kinetic = 0.5 * (rock.mass * moves.squaredNorm() + 0.3 * turns.squaredNorm()),
                     work    = 0.5 * dt * (acting.dot(moves) + torque.dot(turns));
        EXPECT_NEAR(totals[b].scaling_work, work - kinetic, 1e-12 * work) << b;
    }
    EXPECT_EQ(totals[1].scaling_work, 0);
    EXPECT_EQ(totals[1].holding_impulse, Vec3<double>::Zero());

    part.assign({{force, torque, 0}, {force, torque, 0}, {force, torque, 0}});
    move_bodies(this->exec(), step);
    const double kept = 1 + dem::kept_a_substep * (factor - 1);
    EXPECT_EQ(factor_now.to_host(), (std::vector<double>{1, 1, kept})) << "it goes slowly";
}

TYPED_TEST(RigidBody, LocalDampingActsOnWhoTakesPartAndIsCounted)
{
    constexpr double dt = 1e-3, alpha = 0.3;
    constexpr int    steps = 200;
    SolidNumbers     numbers;
    numbers.gravity = {0, 0, -10};
    Solid damped;
    damped.mass     = 2;
    damped.velocity = {0, 0, -1};
    damped.damped   = 1;
    Solid other     = damped;
    other.damped    = 0;
    typename TestFixture::Scene scene(this->exec(), any_shape(), {damped, other}, numbers);
    const dem::BodySums         start = scene.sums();
    for (int step = 0; step < steps; ++step) { scene.move(dt, alpha); }
    const double t = dt * steps;
    EXPECT_NEAR(read(this->exec(), scene.bodies.velocity.data())[2], -1 - 10 * (1 - alpha) * t, 1e-12);
    EXPECT_NEAR(read(this->exec(), scene.bodies.velocity.data() + 1)[2], -1 - 10 * t, 1e-12);

    const dem::BodySums end = scene.sums();
    EXPECT_NEAR(end.total.damping_impulse[2], alpha * 10 * 2 * t, 1e-12);
    // gravity's work differs from m g dz by the half step of symplectic Euler: m g^2 (1 - alpha) t dt/2 and similar
    // terms
    const double lost = start.kinetic + start.potential - end.kinetic - end.potential;
    std::printf("energy lost %.6f J, counted %.6f J, tolerance %.6f J (m g^2 t dt)\n", lost, end.total.damping,
                2 * 100 * t * dt * 2);
    EXPECT_NEAR(lost, end.total.damping, 2 * 100 * t * dt * 2);
    EXPECT_GT(end.total.damping, 1.0);
}

} // namespace
} // namespace tread::test
