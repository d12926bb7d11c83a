#include "contact_places.hpp"

#include <array>
#include <cstdio>
#include <map>
#include <random>

#include <omp.h>

#include "kernels/dem/contact/sdf_kern.hpp"

// Complete contact steps: forces, balance, private point copies, history, summaries.
namespace tread::test
{
namespace contact_step_test
{

template<class Case>
class ContactStep : public ContactTest<Case>
{
};

TYPED_TEST_SUITE(ContactStep, ContactCases, ContactCaseNames);

Vec3<double> sum(const std::vector<Vec3<double>>& values)
{
    Vec3<double> total = Vec3<double>::Zero();
    for (const Vec3<double>& value : values) { total += value; }
    return total;
}

TYPED_TEST(ContactStep, ActionIsReactionForAnyNumberOfSubsteps) // docs/verification.md#momentum-balance
{
    for (const int substeps : {1, 10, 100})
    {
        typename TestFixture::Scene scene(this->exec(), {sphere_shape(0.05, 40)}, {ball()}, skin(3000));
        scene.begin();
        const double dt      = scene.numbers.dt / substeps;
        Vec3<double> on_body = Vec3<double>::Zero();
        double       scale   = 0;
        for (int i = 0; i < substeps; ++i)
        {
            scene.substep(dt);
            on_body += dt * scene.bodies.force.to_host()[0];
            for (const auto& response : scene.contact.response.to_host()) { scale += dt * response.force.norm(); }
        }
        scene.finish();
        const double fp64      = (sum(scene.contact.impulse.to_host()) + on_body).norm() / scale;
        const double real      = (scene.numbers.dt * sum(scene.contact_forces()) + on_body).norm() / scale;
        const bool   single    = std::is_same_v<typename TypeParam::Real, float>;
        const double tolerance = single ? 1e-7 : 1e-12;
        std::printf("[ measured ] N = %3d: imbalance of impulse %.1e (1e-12: rounding of 3000 terms), as given to the "
                    "grid %.1e (%.0e: rounding of the fields)\n",
                    substeps, fp64, real, tolerance);
        EXPECT_LE(fp64, 1e-12);
        EXPECT_LE(real, tolerance);
    }
}

TYPED_TEST(ContactStep, WrenchIsTheSumOverContacts)
{
    typename TestFixture::Scene scene(this->exec(), {sphere_shape(0.05, 40)}, {ball()}, skin(1000));
    scene.begin();
    const auto at = scene.contact.position.to_host();
    scene.substep(1e-4);
    const auto   touched = scene.contact.candidates.touched.to_host();
    const auto   all     = scene.contact.response.to_host();
    Vec3<double> force = Vec3<double>::Zero(), torque = Vec3<double>::Zero();
    double       stiffness = 0, scale = 0;
    for (std::size_t c = 0; c < all.size(); ++c)
    {
        const Vec3<double> arm = at[static_cast<std::size_t>(touched[c])] - ball().position;
        force -= all[c].force;
        torque += all[c].couple - arm.cross(all[c].force);
        stiffness += all[c].stiffness;
        scale += all[c].force.norm();
    }
    EXPECT_GT(scale, 0);
    EXPECT_LE((scene.bodies.force.to_host()[0] - force).norm(), 1e-13 * scale);
    EXPECT_LE((scene.bodies.torque.to_host()[0] - torque).norm(), 1e-13 * scale);
    EXPECT_NEAR(scene.bodies.stiffness.to_host()[0], stiffness, 1e-12 * stiffness);
}

/// Friction acts at the surface of a body: a point that moves with the surface of a spinning ball does not slip,
/// however far its centre is from the surface, and friction has the ball's own radius as its lever arm. The field's
/// normal is off by a hundredth, so the normal force is separated from friction first.
TYPED_TEST(ContactStep, FrictionActsAtTheSurface)
{
    const double       ball_radius = 0.05, away = 0.9 * radius, rate = 10, dt = 1e-6; // no slip yet
    const Vec3<double> out(1, 0, 0), along(0, 1, 0), arm = (ball_radius + away) * out;
    BodyState          spinning = ball();
    spinning.velocity           = Vec3<double>::Zero();
    spinning.angular_velocity   = Vec3<double>(0, 0, rate);
    struct Friction
    {
        double force, torque; ///< N along, N m about the ball's axis
    };
    const auto friction = [&](double speed)
    {
        typename TestFixture::Scene scene(this->exec(), {sphere_shape(ball_radius, 40)}, {spinning},
                                          {{spinning.position + arm, speed * along}});
        scene.begin();
        scene.substep(dt);
        const Vec3<double> tangential = scene.contact.tangential.to_host()[0].force;
        const Vec3<double> normal     = scene.contact.response.to_host()[0].force - tangential;
        return Friction{tangential.dot(along), scene.bodies.torque.to_host()[0][2] + arm.cross(normal)[2]};
    };
    const Friction surface = friction(rate * ball_radius), centre = friction(rate * (ball_radius + away));
    std::printf("[ measured ] friction on a point that goes with the surface: %.4f of that on one that goes with the "
                "body's velocity at its centre, expected 0, tolerance 0.05: the field's normals\n",
                surface.force / centre.force);
    EXPECT_LT(centre.force, 0);
    EXPECT_LE(std::abs(surface.force), 0.05 * std::abs(centre.force));
    const double found = -centre.torque / centre.force;
    std::printf("[ measured ] arm of friction over the ball's radius: %.5f, expected 1, tolerance 5e-3: the field's "
                "distance and normal\n",
                found / ball_radius);
    EXPECT_NEAR(found, ball_radius, 5e-3 * ball_radius);
}

TYPED_TEST(ContactStep, ForceOnAFlatFaceIsHertz)
{
    const double                overlap = 1e-4;
    typename TestFixture::Scene scene(this->exec(), {slab()}, {slab_below()}, {{point_over_slab(overlap)}});
    scene.begin();
    scene.substep(1e-4);
    const double expected = 4.0 / 3.0 * 1e6 * std::sqrt(radius) * std::pow(overlap, 1.5);
    const double measured = -scene.bodies.force.to_host()[0][2];
    // fp32 SDF: 0.02 m is exact to 1e-9 m, r_p of an fp32 volume to 1e-10 m; relative to an overlap of 1e-4 m, times
    // 1.5.
    std::printf("[ measured ] force %.9f N, expected %.9f N, tolerance 3e-5 (fp32 SDF values)\n", measured, expected);
    EXPECT_NEAR(measured, expected, 3e-5 * expected);

    const contact::Summary summary = scene.summary();
    EXPECT_EQ(summary.live, 1);
    EXPECT_EQ(summary.deepest.body, 0);
    EXPECT_EQ(summary.deepest.point_id, 1000u);
    EXPECT_NEAR(summary.deepest.value, overlap / radius, 3e-5 * overlap / radius);
    EXPECT_NEAR(summary.energy, 0.4 * expected * overlap, 1e-4 * 0.4 * expected * overlap);
    EXPECT_NEAR(summary.stiffest.value, 1.5 * expected / overlap / 1e-3, 3e-5 * summary.stiffest.value);
    EXPECT_EQ(summary.flattest.body, -1); // no centre is inside
}

TYPED_TEST(ContactStep, TheFlattestGradientIsThatOfACentreInside)
{
    typename TestFixture::Scene scene(this->exec(), {slab()}, {slab_below()}, {{point_over_slab(1.5 * radius)}});
    scene.begin();
    scene.substep(1e-4);
    EXPECT_EQ(scene.summary().flattest.point_id, 1000u);
    EXPECT_NEAR(scene.summary().flattest.value, 1.0, 1e-5); // a flat face
}

TYPED_TEST(ContactStep, SupportedPointAtRestStays)
{
    const double overlap = 1e-4;
    const auto   run     = [&](contact::PointMotion motion, double support)
    {
        SceneNumbers numbers;
        numbers.motion = motion;
        typename TestFixture::Scene scene(this->exec(), {slab()}, {slab_below()},
                                          {{point_over_slab(overlap), {0, 0, 0}, {0, 0, -support}}}, numbers);
        scene.begin();
        const Vec3<double> start = scene.contact.position.to_host()[0];
        scene.substep(0);
        const double force = -scene.bodies.force.to_host()[0][2];
        for (int i = 0; i < 1000; ++i) { scene.substep(numbers.dt / 1000); }
        const double moved   = (scene.contact.position.to_host()[0] - start).norm();
        const double impulse = scene.contact.impulse.to_host()[0][2];
        return std::array<double, 3>{moved, force, impulse};
    };
    const double force  = run(contact::PointMotion::frozen, 0)[1];
    const auto   held   = run(contact::PointMotion::supported, force / 1e-3);
    const auto   free   = run(contact::PointMotion::ballistic, force / 1e-3);
    const auto   fixed  = run(contact::PointMotion::frozen, force / 1e-3);
    const double recoil = 0.5 * force / 1e-3 * 1e-8;
    std::printf("[ measured ] moved in a step: supported %.2e, ballistic %.2e, frozen %.2e m; free recoil %.2e m\n",
                held[0], free[0], fixed[0], recoil);
    // Support and mass are fp32 at worst: the remaining balance is 1e-7 of the force.
    EXPECT_LE(held[0], 1e-6 * recoil);
    EXPECT_NEAR(held[2], force * 1e-4, 1e-6 * force * 1e-4);
    EXPECT_NEAR(free[0], recoil, 0.02 * recoil); // k dt^2 / 12 m = 1 % softer while it separates
    EXPECT_EQ(fixed[0], 0);
    EXPECT_NEAR(fixed[2], force * 1e-4, 1e-12 * force);
}

TYPED_TEST(ContactStep, PointBetweenTwoBodiesIsHeldByBoth)
{
    const double overlap = 1e-4;
    BodyState    above   = slab_below();
    above.position[2] += 0.04 + 2 * (radius - overlap);
    const Vec3<double>          at = point_over_slab(overlap);
    typename TestFixture::Scene scene(this->exec(), {slab()}, {slab_below(), above}, {{at}});
    scene.begin();
    ASSERT_EQ(scene.contact.candidates.body.size(), 2);
    ASSERT_EQ(scene.contact.position.size(), 1);
    for (int i = 0; i < 1000; ++i) { scene.substep(scene.numbers.dt / 1000); }
    const auto   forces = scene.bodies.force.to_host();
    const double force  = 4.0 / 3.0 * 1e6 * std::sqrt(radius) * std::pow(overlap, 1.5);
    EXPECT_NEAR(forces[0][2], -force, 3e-5 * force);
    EXPECT_NEAR(forces[1][2], force, 3e-5 * force);
    EXPECT_LE((forces[0] + forces[1]).norm(), 6e-5 * force);
    EXPECT_LE((scene.contact.position.to_host()[0] - at).norm(), 1e-4 * overlap);
    EXPECT_EQ(scene.summary().live, 2);
}

TYPED_TEST(ContactStep, HistorySurvivesTheOrderingOfPoints)
{
    SceneNumbers numbers;
    numbers.motion = contact::PointMotion::frozen;
    typename TestFixture::Scene scene(this->exec(), {sphere_shape(0.05, 40), slab()},
                                      {ball(), {{0.5, 0.5, 0.44}, Quat::Identity(), {0, 0, 0}, {0, 0, 0}, 1, 1}},
                                      skin(2000), numbers);
    const auto                  records = [&]
    {
        std::map<std::uint64_t, Vec3<double>> found;
        for (const auto& record : scene.records()) { found[record.key] = record.tangential.force; }
        EXPECT_EQ(static_cast<std::int64_t>(found.size()), scene.contact.history.key.size());
        return found;
    };
    scene.begin();
    scene.substep(1e-4);
    scene.finish();
    const auto before = records();
    ASSERT_GT(before.size(), 1000u);

    // A finer grid reorders the points: ids are kept, memory positions change.
    const auto old_ids    = scene.points.id.to_host();
    scene.numbers.spacing = 0.004;
    scene.order();
    const auto ids = scene.points.id.to_host();
    ASSERT_NE(ids, old_ids);
    scene.begin();
    const auto  body = scene.contact.candidates.body.to_host(), touched = scene.contact.candidates.touched.to_host();
    const auto  id       = scene.contact.id.to_host();
    const auto  recalled = scene.contact.tangential.to_host();
    std::size_t found    = 0;
    for (std::size_t c = 0; c < body.size(); ++c)
    {
        const auto         at = before.find(contact::history_key(body[c], id[static_cast<std::size_t>(touched[c])]));
        const Vec3<double> expected = at == before.end() ? Vec3<double>(Vec3<double>::Zero()) : at->second;
        EXPECT_EQ(recalled[c].force, expected);
        found += at != before.end();
    }
    EXPECT_EQ(found, before.size());
    scene.finish();
    EXPECT_EQ(records(), before) << "a step without substeps changes nothing";
}

TYPED_TEST(ContactStep, PointsOutOfReachGetNoForce)
{
    auto sand = skin(100);
    sand.push_back({{0.2, 0.2, 0.2}});
    typename TestFixture::Scene scene(this->exec(), {sphere_shape(0.05, 40)}, {ball()}, sand);
    scene.points.contact_force.assign(std::vector<typename TypeParam::Real>(3 * sand.size(), 7));
    scene.begin();
    scene.substep(1e-4);
    scene.finish();
    const auto ids    = scene.points.id.to_host();
    const auto forces = scene.contact_forces();
    for (std::size_t i = 0; i < ids.size(); ++i) { EXPECT_EQ(forces[i].norm() > 0, ids[i] != 1100); }
}

TYPED_TEST(ContactStep, SubstepsAllocateNothing)
{
    typename TestFixture::Scene scene(this->exec(), {sphere_shape(0.05, 40)}, {ball()}, skin(1000));
    scene.begin();
    const auto before = this->counters.bytes();
    for (int i = 0; i < 3; ++i) { scene.substep(1e-5); }
    EXPECT_EQ(this->counters.bytes(), before);
}

TYPED_TEST(ContactStep, FrictionlessBallHasNoTorque)
{
    for (const int cells : {20, 40, 80})
    {
        SceneNumbers numbers;
        numbers.pair.friction = 0;
        typename TestFixture::Scene scene(this->exec(), {sphere_shape(0.05, cells)}, {ball()}, skin(3000), numbers);
        scene.begin();
        scene.substep(1e-4);
        double scale = 0;
        for (const auto& response : scene.contact.response.to_host()) { scale += 0.05 * response.force.norm(); }
        const double measured = scene.bodies.torque.to_host()[0].norm() / scale;
        // Each tangential component of a trilinear gradient is off by up to s/(2 R), uniformly: the sum over n points
        // of random position and weight d^1.5, d uniform (0.64 n of equal weight), has the deviation below; 3 are
        // allowed.
        const double deviation = 0.12 / cells / 0.05 * std::sqrt(2.0 / 12.0 / (0.64 * 3000));
        std::printf("[ measured ] %d cells: torque / sum(R F) %.2e, expected 0, tolerance %.1e = 3 deviations\n", cells,
                    measured, 3 * deviation);
        EXPECT_LE(measured, 3 * deviation);
    }
}

TYPED_TEST(ContactStep, SummaryLedgerClosesOverADrag)
{
    // A fixed slab is dragged sideways under frozen points: work of the drag = elastic energy gained + friction heat.
    SceneNumbers numbers;
    numbers.motion = contact::PointMotion::frozen;
    std::vector<PointState> sand;
    for (int i = 0; i < 20; ++i)
    {
        sand.push_back({point_over_slab(2e-5 * (i + 1)) + Vec3<double>(3e-3 * (i % 5), 3e-3 * (i / 5), 0)});
    }
    BodyState body = slab_below();
    body.velocity  = {0.1, 0.05, 0};
    typename TestFixture::Scene scene(this->exec(), {slab()}, {body}, sand, numbers);

    double       work = 0, heat = 0, start = 0, dt = 1e-6;
    Vec3<double> last = Vec3<double>::Zero();
    for (int step = 0; step < 20; ++step)
    {
        scene.begin();
        if (step == 0)
        {
            scene.substep(0);
            start = scene.summary().energy;
        }
        for (int i = 0; i < 100; ++i)
        {
            scene.substep(dt);
            const Vec3<double> force = scene.bodies.force.to_host()[0];
            work -= dt * 0.5 * (force + last).dot(body.velocity);
            last    = force;
            auto at = scene.bodies.position.to_host();
            at[0] += dt * body.velocity;
            scene.bodies.position.assign(at);
        }
        heat += scene.summary().dissipated;
        scene.finish();
    }
    const double stored = scene.summary().energy - start;
    std::printf("[ measured ] work %.6e J, heat %.6e J, stored %.6e J, unaccounted %.2e of the work; tolerance 1e-3 "
                "(trapezoid over the kink at the onset of slip)\n",
                work, heat, stored, (work - heat - stored) / work);
    EXPECT_GT(heat, 0.1 * work);
    EXPECT_GT(stored, 0);
    EXPECT_NEAR(heat + stored, work, 1e-3 * work);
}

/// Work of the normal force along a closed path that enters, slides along and leaves a body.
TEST(PointBodyPath, NormalForceDoesNoWorkAroundALoop)
{
    const AnalyticShape             shape = sphere_shape(0.02, 40);
    Counters                        counters;
    const ContactScene<Cpu, double> scene(Cpu{&counters}, {shape}, {{{0.5, 0.5, 0.5}}}, {{{0.5, 0.5, 0.9}}});
    const dem::TemplateView         view = scene.host_template(shape);
    const Quat                      turned(Eigen::AngleAxisd(0.5, Vec3<double>(1, 2, 3).normalized()));
    const contact::PairConstants    pair{1e6, 3e5, 0, 1, radius, contact::effective_radius(radius, 0.02)};
    contact::Tangential             none  = contact::no_tangential();
    const int                       steps = 20000;
    double                          work = 0, exchanged = 0, highest = 0;
    Vec3<double>                    last_force = Vec3<double>::Zero(), last_at = Vec3<double>::Zero();
    for (int i = 0; i <= steps; ++i)
    {
        const double       angle = 2 * 3.14159265358979323846 * i / steps;
        const Vec3<double> at =
            Vec3<double>(0.008 * std::cos(angle), 0.003 * std::cos(angle), 0.0215 + 0.003 * std::sin(angle));
        const auto field = dem::sample_body_sdf(view, 1.0, Vec3<double>::Zero(), turned, at);
        const auto response =
            point_body_response(pair, {field.distance, field.gradient, Vec3<double>::Zero()}, none, 1e-5);
        if (i > 0)
        {
            const double increment = 0.5 * (response.force + last_force).dot(at - last_at);
            work += increment;
            exchanged += std::abs(increment);
        }
        highest    = std::max(highest, response.energy);
        last_force = response.force;
        last_at    = at;
    }
    std::printf("[ measured ] work around the loop %.2e of the greatest energy (exchanged %.2f), tolerance 1e-3 of the "
                "design\n",
                work / highest, exchanged / highest);
    EXPECT_GT(exchanged, highest);
    EXPECT_LE(std::abs(work), 1e-3 * highest);
}

TEST(PointContactThreads, SameBitsForAnyNumber)
{
    std::vector<Vec3<double>> first;
    const int                 wanted = omp_get_max_threads();
    for (const int threads : {1, 2, 3})
    {
        omp_set_num_threads(threads);
        Counters                 counters;
        ContactScene<Cpu, float> scene(Cpu{&counters}, {sphere_shape(0.05, 40)}, {ball()}, skin(3000));
        scene.begin();
        for (int i = 0; i < 5; ++i) { scene.substep(2e-5); }
        scene.finish();
        auto result = scene.contact_forces();
        result.push_back(scene.bodies.force.to_host()[0]);
        result.push_back(scene.bodies.torque.to_host()[0]);
        if (first.empty()) { first = result; }
        EXPECT_TRUE(result == first) << threads << " threads";
    }
    omp_set_num_threads(wanted);
}

} // namespace contact_step_test
} // namespace tread::test
