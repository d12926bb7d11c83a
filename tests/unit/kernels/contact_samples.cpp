#include "contact_scene.hpp"

#include <cstdio>
#include <map>
#include <random>

#include "kernels/contact/history_kern.hpp"
#include "kernels/contact/samples_kern.hpp"

// Points that use nine samples against bodies as small as themselves.
namespace tread::test
{
namespace contact_samples_test
{

const double radius = contact::point_radius(SceneNumbers{}.volume, contact::RadiusRule::sphere);

template<class Case>
class ContactSamples : public ContactTest<Case>
{
};
TYPED_TEST_SUITE(ContactSamples, ContactCases, ContactCaseNames);

SceneNumbers sampling()
{
    SceneNumbers numbers;
    numbers.sampled_below = 3 * radius;
    return numbers;
}

/// A ball of the points' own size, and points in its skin, sliding over it.
BodyState pebble() { return {Vec3<double>::Constant(0.5), Quat::Identity(), {0.1, 0, 0}, {0, 30, 10}}; }

std::vector<PointState> skin(std::size_t count, double deepest)
{
    std::mt19937                           random(7);
    std::normal_distribution<double>       normal;
    std::uniform_real_distribution<double> depth(0, deepest);
    std::vector<PointState>                sand;
    for (std::size_t i = 0; i < count; ++i)
    {
        const Vec3<double> outwards = Vec3<double>(normal(random), normal(random), normal(random)).normalized();
        sand.push_back({Vec3<double>::Constant(0.5) + (2 * radius - depth(random)) * outwards,
                        0.1 * Vec3<double>(normal(random), normal(random), normal(random))});
    }
    return sand;
}

/// A ball whose field extends to all points and samples.
AnalyticShape ball_shape(int cells)
{
    return {Vec3<double>::Constant(2.4 * radius), radius, cells,
            [](const Vec3<double>& x) { return x.norm() - radius; }};
}

/// Hertz's force at distance `phi` from a body of equivalent radius `body`, with the numbers of SceneNumbers.
double hertz(double phi, double body)
{
    const double overlap = radius - phi;
    if (!(overlap > 0)) { return 0; }
    return 4.0 / 3.0 * 1e6 * std::sqrt(contact::effective_radius(radius, body)) * std::pow(overlap, 1.5);
}

TYPED_TEST(ContactSamples, ForceOfABallIsTheMeanOfNine)
{
    const AnalyticShape ball    = ball_shape(160);
    SceneNumbers        numbers = sampling();
    numbers.pair.friction       = 0;
    for (const double overlap : {0.02, 0.2, 0.5})
    {
        std::mt19937                     random(3);
        std::normal_distribution<double> normal;
        for (int i = 0; i < 10; ++i)
        {
            const Vec3<double> outwards = Vec3<double>(normal(random), normal(random), normal(random)).normalized();
            const double       away     = (2 - overlap) * radius;
            typename TestFixture::Scene scene(this->exec(), {ball}, {{Vec3<double>::Constant(0.5)}},
                                              {{Vec3<double>::Constant(0.5) + away * outwards}}, numbers);
            scene.begin();
            scene.substep(1e-4);
            double       expected = hertz(away - radius, radius);
            const double far      = std::hypot(away, contact::patch_reach * radius);
            expected += 8 * hertz(far - radius, radius) * away / far;
            expected /= 9;
            const double measured = -scene.bodies.force.to_host()[0].dot(outwards);
            // Cells of s = 0.036 R interpolate a distance whose slope changes by 2/(1.5 R) to s^2/4/(1.5 R) = 2.2e-4 R,
            // and force ~ overlap^1.5; slopes are off by s/2/(1.5 R) = 1.2 % across, which enters through the
            // inclination of the outer samples, at most 0.45.
            const double tolerance = 1.5 * 2.2e-4 / overlap + 0.45 * 1.2e-2;
            if (i == 0)
            {
                std::printf("[ measured ] overlap %.2f r: force %.6f N, expected %.6f N, tolerance %.1e (cells)\n",
                            overlap, measured, expected, tolerance);
            }
            EXPECT_NEAR(measured, expected, tolerance * expected);
        }
    }
}

TYPED_TEST(ContactSamples, ActionIsReaction)
{
    typename TestFixture::Scene scene(this->exec(), {ball_shape(80)}, {pebble()}, skin(300, 0.3 * radius), sampling());
    scene.begin();
    Vec3<double> on_body = Vec3<double>::Zero(), on_points = Vec3<double>::Zero();
    double       scale = 0;
    for (int i = 0; i < 10; ++i)
    {
        scene.substep(1e-5);
        on_body += 1e-5 * scene.bodies.force.to_host()[0];
        for (const auto& response : scene.contact.response.to_host()) { scale += 1e-5 * response.force.norm(); }
    }
    for (const Vec3<double>& impulse : scene.contact.impulse.to_host()) { on_points += impulse; }
    const double error = (on_body + on_points).norm() / scale;
    std::printf("[ measured ] imbalance of impulse %.1e, expected 0, tolerance 1e-12 (rounding of 300 terms)\n", error);
    EXPECT_GT(scale, 0);
    EXPECT_LE(error, 1e-12);
}

/// A block with a groove too narrow for any point's sphere: only samples touch its walls.
AnalyticShape grooved_block()
{
    const Vec3<double> half = Vec3<double>::Constant(2 * radius);
    const auto         box = [](const Vec3<double>& q) { return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0); };
    return {half, 2 * radius, 60,
            [=](const Vec3<double>& x)
            {
                const Vec3<double> slot(std::abs(x[0]) - 0.6 * radius, std::abs(x[1]) - 4 * radius,
                                        std::abs(x[2] - 2 * radius) - 1.5 * radius);
                return std::max(box(x.cwiseAbs() - half), -box(slot));
            }};
}

TYPED_TEST(ContactSamples, NoSampleInContactIsMissed)
{
    std::mt19937                           random(5);
    std::uniform_real_distribution<double> place(-4 * radius, 4 * radius);
    std::vector<PointState>                sand;
    for (int i = 0; i < 4000; ++i)
    {
        sand.push_back({Vec3<double>(0.5 + place(random), 0.5 + place(random), 0.5 + place(random))});
    }
    const AnalyticShape shape = grooved_block();
    const Quat          turned(Eigen::AngleAxisd(0.7, Vec3<double>(1, 2, 3).normalized()));
    SceneNumbers        numbers = sampling();
    numbers.point_speed         = 0;
    typename TestFixture::Scene scene(this->exec(), {shape}, {{Vec3<double>::Constant(0.5), turned}}, sand, numbers);
    scene.find();
    const auto             found = scene.contact.candidates.point.to_host();
    const std::vector<int> listed(found.begin(), found.end());
    const auto             view      = scene.host_template(shape);
    const auto             positions = scene.positions();
    int                    touching = 0, by_samples_alone = 0;
    for (std::size_t i = 0; i < positions.size(); ++i)
    {
        const Vec3<double> arm      = positions[i] - Vec3<double>::Constant(0.5);
        const auto         axes     = contact::patch_axes(arm.normalized());
        const auto         distance = [&](const Vec3<double>& x)
        { return dem::sample_body_sdf(view, 1.0, Vec3<double>::Constant(0.5), turned, x).distance; };
        bool touches = false;
        for (int s = 0; s < 9; ++s)
        {
            touches = touches || distance(positions[i] + contact::patch_offset(axes, s, radius)) < radius;
        }
        touching += touches;
        by_samples_alone += touches && !(distance(positions[i]) < radius);
        if (touches) { EXPECT_TRUE(std::count(listed.begin(), listed.end(), static_cast<int>(i)) == 1) << i; }
    }
    std::printf("[ measured ] %d points touch, %d of them by other samples than the centre; %zu listed\n", touching,
                by_samples_alone, listed.size());
    EXPECT_GT(by_samples_alone, 10);
}

TYPED_TEST(ContactSamples, EachSampleHasItsHistory)
{
    // A ball of the points' size beside a large one: nine sub-ids for the first, none for the second.
    SceneNumbers numbers = sampling();
    numbers.motion       = contact::PointMotion::frozen;
    typename TestFixture::Scene scene(this->exec(), {ball_shape(80), sphere_shape(0.05, 40)},
                                      {pebble(), {{0.5, 0.5, 0.449}, Quat::Identity(), {0, 0, 0}, {0, 0, 0}, 1, 1}},
                                      skin(500, 0.8 * radius), numbers);
    scene.begin();
    scene.substep(1e-4);
    scene.finish();
    const auto         before = scene.records();
    std::map<int, int> samples, large;
    for (const auto& record : before)
    {
        auto& found = record.key >> 36 == 0 ? samples : large;
        ++found[static_cast<int>(record.key & 15U) - 1];
    }
    EXPECT_EQ(samples.size(), 9u);
    EXPECT_EQ(samples.count(0), 0u);
    ASSERT_EQ(large.size(), 1u);
    EXPECT_GT(large[0], 10);

    // A finer grid reorders the points: ids are kept, memory positions change.
    const auto old_ids    = scene.points.id.to_host();
    scene.numbers.spacing = 0.001;
    scene.order();
    ASSERT_NE(scene.points.id.to_host(), old_ids);
    scene.begin();
    scene.finish();
    const auto after = scene.records();
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t i = 0; i < after.size(); ++i)
    {
        EXPECT_EQ(after[i].key, before[i].key);
        EXPECT_EQ(after[i].tangential.force, before[i].tangential.force);
    }
}

TYPED_TEST(ContactSamples, SceneWithoutThemHasNoSlots)
{
    typename TestFixture::Scene scene(this->exec(), {ball_shape(80)}, {pebble()}, skin(300, 0.3 * radius));
    scene.begin();
    scene.substep(1e-5);
    scene.finish();
    EXPECT_EQ(this->counters.bytes().count("contact slots"), 0u);
    EXPECT_EQ(this->counters.launches().count("count contact slots"), 0u);
    EXPECT_EQ(this->counters.launches().count("sampled point-body forces"), 0u);
}

} // namespace contact_samples_test
} // namespace tread::test
