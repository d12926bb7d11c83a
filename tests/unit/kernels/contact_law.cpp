#include "kernels/contact/point_body_kern.hpp"

#include <cstdio>
#include <limits>
#include <random>

#include <gtest/gtest.h>

// The law of a single contact, compared with closed forms.
namespace
{

using namespace tread;
using namespace tread::contact;

constexpr PairConstants pair{1e6, 3e5, 0.3, 1.0, 3e-3, 2.5e-3};

const Vec3<double> up(0, 0, 1);

Approach at_overlap(double overlap, const Vec3<double>& velocity = Vec3<double>::Zero())
{
    return {pair.point_radius - overlap, up, velocity};
}

TEST(PointBodyLaw, RadiusFollowsItsRule)
{
    const double pi = 3.14159265358979323846;
    EXPECT_NEAR(point_radius(4.0 / 3.0 * pi * 8e-9, RadiusRule::sphere), 2e-3, 1e-15);
    EXPECT_NEAR(point_radius(8e-9, RadiusRule::semi_domain), 1e-3, 1e-15);
    EXPECT_NEAR(effective_radius(2e-3, std::numeric_limits<double>::infinity()), 2e-3, 1e-18);
    EXPECT_NEAR(effective_radius(2e-3, 2e-3), 1e-3, 1e-18);
}

TEST(PointBodyLaw, NormalForceIsHertzAndDerivesFromItsEnergy)
{
    const double d = 1e-4, step = 1e-8;
    Tangential   tangential = no_tangential();
    const auto   at = [&](double overlap) { return point_body_response(pair, at_overlap(overlap), tangential, 1e-5); };

    const double expected = 4.0 / 3.0 * 1e6 * std::sqrt(2.5e-3) * std::pow(d, 1.5);
    EXPECT_NEAR(at(d).force[2], expected, 1e-14 * expected);
    EXPECT_NEAR(at(d).energy, 0.4 * expected * d, 1e-14 * expected * d);
    // Central differences of d^1.5 and d^2.5: relative error (step/d)^2 / 24 and rounding 1e-16 d/step.
    EXPECT_NEAR((at(d + step).energy - at(d - step).energy) / (2 * step), expected, 1e-8 * expected);
    EXPECT_NEAR((at(d + step).force[2] - at(d - step).force[2]) / (2 * step), at(d).stiffness, 1e-8 * at(d).stiffness);
}

TEST(PointBodyLaw, PairsApartFeelNothingAndForget)
{
    Tangential tangential = no_tangential();
    point_body_response(pair, at_overlap(1e-4, {0.1, 0, 0}), tangential, 1e-5);
    ASSERT_GT(tangential.force.norm(), 0);
    const double   stored = dem::spring_energy(tangential.force.squaredNorm(), tangential.stiffness);
    const Response apart  = point_body_response(pair, at_overlap(0), tangential, 1e-5);
    EXPECT_EQ(apart.force.norm(), 0);
    EXPECT_EQ(apart.energy, 0);
    EXPECT_EQ(apart.dissipated, stored);
    EXPECT_EQ(tangential.force.norm(), 0);
    EXPECT_EQ(tangential.stiffness, 0);
}

TEST(PointBodyLaw, SlidingForceIsCoulombsAgainstTheMotion)
{
    const Vec3<double> velocity   = Vec3<double>(0.3, -0.4, 0.2);
    Tangential         tangential = no_tangential();
    Response           response   = no_response();
    for (int i = 0; i < 100; ++i)
    {
        response = point_body_response(pair, at_overlap(1e-4, velocity), tangential, 1e-4);
        ASSERT_LE(tangential.force.norm(), pair.friction * response.force[2] * (1 + 1e-14));
    }
    const Vec3<double> expected = -pair.friction * response.force[2] * Vec3<double>(0.6, -0.8, 0);
    EXPECT_LE((tangential.force - expected).norm(), 1e-12 * expected.norm());
    // All work of steady sliding is dissipated: cap times slip.
    EXPECT_NEAR(response.dissipated, expected.norm() * 0.5 * 1e-4, 1e-12 * response.dissipated);
}

/// Shears the spring at constant overlap; returns the work of the motion, stored or dissipated.
double shear(Tangential& tangential, double overlap, double distance)
{
    const PairConstants sticky{pair.effective_young, pair.effective_shear, 1e6,
                               pair.hertz_factor,    pair.point_radius,    pair.effective_radius};
    const double        before = dem::spring_energy(tangential.force.squaredNorm(), tangential.stiffness);
    const double normal = 8.0 / 15.0 * pair.effective_young * std::sqrt(pair.effective_radius) * std::pow(overlap, 2.5);
    const Response after = point_body_response(sticky, at_overlap(overlap, {distance, 0, 0}), tangential, 1.0);
    return after.energy - normal - before + after.dissipated;
}

TEST(PointBodyLaw, RatchetGivesBackHalfOfWhatItStored) // docs/verification.md#closed-cycles-of-friction
{
    const double loaded = 4e-4, unloaded = 1e-4, distance = 1e-6;
    Tangential   tangential = no_tangential();
    const double stored     = shear(tangential, loaded, distance);
    shear(tangential, unloaded, 0);
    const double back      = -tangential.force[0] / tangential.stiffness;
    const double extracted = -shear(tangential, unloaded, -back);
    std::printf(
        "[ measured ] extracted/stored %.15f, expected 0.5, tolerance 1e-9 (d^2.5 subtracts the normal energy)\n",
        extracted / stored);
    EXPECT_NEAR(extracted / stored, 0.5, 1e-9);
    EXPECT_NEAR(tangential.force[0], 0, 1e-12);
}

TEST(PointBodyLaw, NoClosedCycleGainsEnergy) // docs/verification.md#closed-cycles-of-friction
{
    std::mt19937                           random(7);
    std::uniform_real_distribution<double> share(0, 1);
    double                                 gain = 0, heat = 0, worst = std::numeric_limits<double>::infinity();
    for (int cycle = 0; cycle < 10000; ++cycle)
    {
        const double d[] = {1e-4 * (0.1 + share(random)), 1e-4 * (0.1 + share(random)), 1e-4 * (0.1 + share(random))};
        const double s   = 1e-5 * share(random); // one in two slips
        Tangential   tangential = no_tangential();
        double       work = 0, lost = 0;
        const auto   go = [&](double overlap, const Vec3<double>& by)
        {
            const Vec3<double> before = tangential.force;
            const Response     r      = point_body_response(pair, at_overlap(overlap, by), tangential, 1.0);
            // Work against the force, which changes linearly during a stick increment.
            if (tangential.stiffness > 0 && by.norm() > 0) { work -= 0.5 * (before + tangential.force).dot(by); }
            lost += r.dissipated;
            ASSERT_GE(r.dissipated, -1e-18);
        };
        go(d[0], {s, 0, 0});
        go(d[1], Vec3<double>::Zero());
        go(d[1], {0, s, 0});
        go(d[2], Vec3<double>::Zero());
        go(d[2], {-s, -s, 0});
        go(0, Vec3<double>::Zero());
        worst = std::min(worst, work);
        gain += work;
        heat += lost;
    }
    std::printf("[ measured ] least work put into one closed cycle %.3e J (>= -1e-18), sum %.6e J, heat %.6e J\n",
                worst, gain, heat);
    EXPECT_GE(worst, -1e-18);
    EXPECT_GT(heat, 0);
}

TEST(PointBodyLaw,
     HistoryTurnsWithTheContact) // docs/verification.md#closed-cycles-of-friction: whole system at 10 rad/s
{
    const Vec3<double> axis  = Vec3<double>(0.3, 1.0, 0).normalized();
    const double       omega = 10, dt = 1e-4;
    const Vec3<double> start(0.2, 0.1, 0);
    Tangential         tangential{start, up, 1.0};
    const int          steps = 6000;
    for (int i = 1; i <= steps; ++i)
    {
        const Vec3<double> normal = Eigen::AngleAxisd(omega * dt * i, axis) * up;
        update_tangential(tangential, normal, Vec3<double>::Zero(), 1.0, 1e9, dt);
    }
    const Vec3<double> expected = Eigen::AngleAxisd(omega * dt * steps, axis) * start;
    std::printf("[ measured ] length %.15f of 1, direction off by %.2e; tolerance 1e-6 of "
                "docs/verification.md#closed-cycles-of-friction\n",
                tangential.force.norm() / start.norm(), (tangential.force - expected).norm() / start.norm());
    EXPECT_NEAR(tangential.force.norm() / start.norm(), 1.0, 1e-6);
    EXPECT_LE((tangential.force - expected).norm(), 1e-6 * start.norm());
    EXPECT_NEAR(tangential.force.dot(tangential.normal), 0, 1e-12);
}

TEST(PointBodyLaw, FlippedNormalForgets)
{
    EXPECT_EQ(dem::turn_with_normal({1, 0, 0}, up, -up).norm(), 0);
    EXPECT_LE((dem::turn_with_normal({1, 0, 0}, up, {1, 0, 0}) - Vec3<double>(0, 0, -1)).norm(), 1e-15);
}

} // namespace
