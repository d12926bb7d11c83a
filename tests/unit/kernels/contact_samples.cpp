#include "contact_scene.hpp"

#include <cstdio>
#include <map>
#include <random>

#include "kernels/contact/history_kern.hpp"
#include "kernels/contact/samples_kern.hpp"

// Points that use nine samples against bodies as small as themselves.
namespace tread::test
{
namespace
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

/// A body given by its exact distance field, at the origin.
struct Exact
{
    std::function<dem::SdfSample(const Vec3<double>&)> sdf;
    double                                             equivalent_radius;
};

Exact exact_ball(double size)
{
    return {[=](const Vec3<double>& x) { return dem::SdfSample{x.norm() - size, x.normalized()}; }, size};
}

Exact exact_cube(double half, const Quat& turned)
{
    return {[=](const Vec3<double>& x)
            {
                const Vec3<double> local = turned.conjugate() * x;
                const Vec3<double> q     = local.cwiseAbs() - Vec3<double>::Constant(half);
                Vec3<double>       slope = q.cwiseMax(0.0);
                if (!(slope.norm() > 0))
                {
                    int face = 0;
                    q.maxCoeff(&face);
                    slope[face] = 1;
                }
                slope = slope.normalized().cwiseProduct(local.cwiseSign());
                return dem::SdfSample{q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0), turned * slope};
            },
            1.24 * half};
}

contact::PairConstants frictionless(const Exact& body)
{
    return {1e6, 3e5, 0, 1, radius, contact::effective_radius(radius, body.equivalent_radius)};
}

/// Force and energy of a point at x, by nine samples.
contact::Response nine(const Exact& body, const Vec3<double>& x)
{
    std::array<contact::Tangential, 9> none;
    none.fill(contact::no_tangential());
    const auto sdf = [&](const Vec3<double>& offset) { return body.sdf(x + offset); };
    return contact::sampled_response(frictionless(body), x, Vec3<double>::Zero(), Vec3<double>::Zero(), sdf, 1.0,
                                     none.data(), 1e-5);
}

using Offsets = std::vector<Vec3<double>>;

Offsets nine_offsets(const Vec3<double>& x)
{
    Offsets offsets;
    for (int s = 0; s < 9; ++s)
    {
        offsets.push_back(contact::patch_offset(contact::patch_axes(x.normalized()), s, radius));
    }
    return offsets;
}

/// Offsets over the whole patch, in pieces of equal area.
Offsets patch_offsets(const Vec3<double>& x)
{
    const auto    axes  = contact::patch_axes(x.normalized());
    constexpr int rings = 40, spokes = 160;
    Offsets       offsets;
    for (int i = 0; i < rings * spokes; ++i)
    {
        const double ring  = contact::patch_radius * radius * std::sqrt((i / spokes + 0.5) / rings);
        const double angle = 2 * 3.14159265358979323846 * (i % spokes) / spokes;
        offsets.push_back(ring * (std::cos(angle) * axes.first + std::sin(angle) * axes.second));
    }
    return offsets;
}

struct ForceAndCouple
{
    Vec3<double> force;  ///< N, on the point
    Vec3<double> couple; ///< N m, of the samples' mean forces about the point
};

ForceAndCouple by_offsets(const Exact& body, const Vec3<double>& x, const Offsets& offsets)
{
    ForceAndCouple sum{Vec3<double>::Zero(), Vec3<double>::Zero()};
    for (const Vec3<double>& offset : offsets)
    {
        const auto at   = body.sdf(x + offset);
        auto       none = contact::no_tangential();
        const auto one  = contact::point_body_response(frictionless(body),
                                                       {at.distance, at.gradient, Vec3<double>::Zero()}, none, 1e-5);
        sum.force += one.force / static_cast<double>(offsets.size());
        sum.couple += offset.cross(one.force) / static_cast<double>(offsets.size());
    }
    sum.force += sum.couple.cross(x.normalized()) / x.norm();
    return sum;
}

TEST(ContactSampling, NineComeCloserThanOneToTheWholePatch)
{
    // Ball of the point's size, d = 0.4 r deep. In u = (rho / rim)^2 the force across the patch is f0 (1 - 1.13 u +
    // 0.43 u^2 - ...): the mean of u is exact, that of u^2 is 8/9 (3/4)^4 instead of 1/3. The error is -3.9 % of the
    // mean.
    const Exact        ball  = exact_ball(radius);
    const Vec3<double> x     = 1.6 * radius * Vec3<double>(0.48, 0.6, 0.64);
    const double       whole = by_offsets(ball, x, patch_offsets(x)).force.norm(), samples = nine(ball, x).force.norm(),
                 single = by_offsets(ball, x, {Vec3<double>::Zero()}).force.norm();
    std::printf("[ measured ] ball: force over that of the patch %.4f, expected 1, tolerance 0.04 (fourth moment); one "
                "sample %.3f\n",
                samples / whole, single / whole);
    EXPECT_NEAR(samples, whole, 0.04 * whole);

    // Past the edge of a cube: the patch leaves the face gradually. Three rows are off by at most half a row, a sixth
    // of the force on the face; the torque about the cube's centre by that times the lever arm.
    const Exact  cube  = exact_cube(1.5 * radius, Quat::Identity());
    const double face  = by_offsets(cube, {0, 0, 2.2 * radius}, {Vec3<double>::Zero()}).force.norm();
    double       error = 0, single_error = 0, torque_error = 0, single_torque = 0;
    for (int i = 0; i <= 40; ++i)
    {
        const Vec3<double> at(0.05 * i * radius, 0.013 * i * radius, 2.2 * radius);
        const Vec3<double> wanted = by_offsets(cube, at, patch_offsets(at)).force, found = nine(cube, at).force,
                           alone = by_offsets(cube, at, {Vec3<double>::Zero()}).force;
        error                    = std::max(error, (found - wanted).norm() / face);
        single_error             = std::max(single_error, (alone - wanted).norm() / face);
        torque_error             = std::max(torque_error, at.cross(found - wanted).norm() / at.norm() / face);
        single_torque            = std::max(single_torque, at.cross(alone - wanted).norm() / at.norm() / face);
    }
    std::printf("[ measured ] edge of a cube: largest error over the force on the face %.4f, over that times the arm "
                "%.4f, expected 0, tolerance 0.167 (half a column); one sample %.3f, %.3f\n",
                error, torque_error, single_error, single_torque);
    EXPECT_LE(error, 1.0 / 6);
    EXPECT_LE(torque_error, 1.0 / 6);
    EXPECT_LT(error, single_error);
}

/// Around a closed path of the point's position and the body's orientation, over faces, edges and a corner of a cube of
/// the point's size, force and torque do no work except that of the neglected part: the samples' couple about the line
/// to the body's centre, on the point's rotation about it relative to the body.
TEST(ContactSampling, NoWorkAroundALoopButWhatIsLeftOut)
{
    const int          steps = 40000;
    const double       turn  = 2 * 3.14159265358979323846;
    const Vec3<double> axis  = Vec3<double>(1, 2, 3).normalized();
    double             work = 0, left_out = 0, exchanged = 0, highest = 0, last_swing = 0;
    Vec3<double> last_at = Vec3<double>::Zero(), last_force = last_at, last_torque = last_at, last_first = last_at;
    for (int i = 0; i <= steps; ++i)
    {
        const double       angle = turn * i / steps, swing = 0.5 * std::sin(2 * angle + 1);
        const Vec3<double> at =
            radius * Vec3<double>(1.4 * std::cos(angle), 0.9 * std::cos(angle + 0.4), 1.9 + 0.6 * std::sin(angle));
        const Exact        cube   = exact_cube(radius, Quat(Eigen::AngleAxisd(swing, axis)));
        const auto         found  = nine(cube, at);
        const Vec3<double> torque = -at.cross(found.force); // on the body
        const Vec3<double> line   = at.normalized();
        const auto         axes   = contact::patch_axes(line);
        if (i > 0)
        {
            const double increment = 0.5 * (found.force + last_force).dot(at - last_at) +
                                     0.5 * (torque + last_torque).dot(axis) * (swing - last_swing);
            work += increment;
            exchanged += std::abs(increment);
            left_out += by_offsets(cube, at, nine_offsets(at)).couple.dot(line) *
                        (axes.second.dot(axes.first - last_first) - line.dot(axis) * (swing - last_swing));
        }
        highest     = std::max(highest, found.energy);
        last_force  = found.force;
        last_torque = torque;
        last_at     = at;
        last_first  = axes.first;
        last_swing  = swing;
    }
    std::printf(
        "[ measured ] work around the loop %.2e of the greatest energy (exchanged %.2f), expected %.2e, tolerance "
        "1e-3 of the design\n",
        work / highest, exchanged / highest, -left_out / highest);
    EXPECT_GT(exchanged, highest);
    EXPECT_NEAR(work, -left_out, 1e-3 * highest);
    EXPECT_LE(std::abs(work), 0.05 * highest);
}

} // namespace
} // namespace tread::test
