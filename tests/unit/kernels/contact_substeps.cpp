#include "contact_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <random>
#include <utility>

#include "kernels/dem/pairs/displacement_tracker.hpp"

// Substeps of sand and bodies in one launch, without the host.
namespace tread::test
{
namespace
{

template<class Case>
class ContactSubsteps : public ContactTest<Case>
{
};

TYPED_TEST_SUITE(ContactSubsteps, ContactCases, ContactCaseNames);

/// Two balls, each among over a thousand points: sums over several parts.
std::vector<BodyState> balls()
{
    return {{{0.4, 0.5, 0.5}, Quat::Identity(), {0.1, 0, 0}, {0, 3, 1}},
            {{0.6, 0.5, 0.5}, Quat::Identity(), {0, 0, -0.2}, {1, 0, 0}}};
}

std::vector<PointState> crowd()
{
    std::mt19937                     random(5);
    std::normal_distribution<double> normal;
    std::vector<PointState>          sand;
    for (int i = 0; i < 3000; ++i)
    {
        const Vec3<double> outwards = Vec3<double>(normal(random), normal(random), normal(random)).normalized();
        sand.push_back({balls()[static_cast<std::size_t>(i % 2)].position + 0.053 * outwards});
    }
    return sand;
}

/// Largest difference over the largest value.
template<class Exec>
double difference(const Array<Exec, Vec3<double>>& one, const Array<Exec, Vec3<double>>& other)
{
    const auto values = one.to_host(), others = other.to_host();
    double     largest = 0, apart = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
    {
        largest = std::max(largest, values[i].norm());
        apart   = std::max(apart, (values[i] - others[i]).norm());
    }
    return apart / largest;
}

/// Limit of differences between one launch and many: the same operations in the same order, but a GPU compiler may fuse
/// a product and a sum in one kernel and not in another: rounding over 20 substeps, and forces that amplify 1e-16 of a
/// position to 1e-12 of an overlap.
template<class Exec>
constexpr double rounding = std::is_same_v<Exec, Cpu> ? 0.0 : 1e-10;

template<class Exec>
void expect_same(const char* name, const Array<Exec, Vec3<double>>& value, const Array<Exec, Vec3<double>>& expected)
{
    const double found = difference(value, expected);
    std::printf("%s of one launch off by %.1e, tolerance %.0e (rounding)\n", name, found, rounding<Exec>);
    EXPECT_LE(found, rounding<Exec>);
}

/// Bodies among points, with `count` substeps in one launch and one by one.
template<class Scene, class Exec>
void expect_the_same_in_one_launch(const Exec& exec, const std::vector<BodyState>& bodies, int count)
{
    constexpr double    dt    = 1e-5;
    const AnalyticShape shape = sphere_shape(0.05, 40);
    Scene               one(exec, {shape}, bodies, crowd());
    Scene               other(exec, {shape}, bodies, crowd());
    one.begin();
    other.begin();
    const auto before = other.bodies.velocity.to_host();
    EXPECT_EQ(worth_one_launch(exec, other.contact, other.body_step(dt)), (!std::is_same_v<Exec, Cpu>));
    run_substeps(exec, other.contact, other.law(), other.body_step(dt), count);
    for (int i = 0; i < count; ++i)
    {
        contact::substep(exec, one.contact, one.bodies.view(), one.law(), dt);
        move_bodies(exec, one.body_step(dt));
    }
    EXPECT_GT((one.bodies.velocity.to_host()[0] - before[0]).norm(), 5e-5);
    expect_same("velocity", other.bodies.velocity, one.bodies.velocity);
    expect_same("angular velocity", other.bodies.angular_velocity, one.bodies.angular_velocity);
    expect_same("position", other.bodies.position, one.bodies.position);
    expect_same("force", other.bodies.force, one.bodies.force);
    expect_same("place of a point", other.contact.position, one.contact.position);
    expect_same("impulse of a point", other.contact.impulse, one.contact.impulse);
    const double work = one.totals.to_host()[0].sand_work;
    EXPECT_NEAR(other.totals.to_host()[0].sand_work, work, rounding<Exec> * std::fabs(work));
    const auto   lost = one.contact.dissipated.to_host(), lost_too = other.contact.dissipated.to_host();
    const double all = std::accumulate(lost.begin(), lost.end(), 0.0);
    EXPECT_NEAR(std::accumulate(lost_too.begin(), lost_too.end(), 0.0), all, rounding<Exec> * all);
}

TYPED_TEST(ContactSubsteps, AreTheSameInOneLaunch)
{
    expect_the_same_in_one_launch<typename TestFixture::Scene>(this->exec(), balls(), 20);
}

/// On a GPU every block moves a body that touches only sand.
TYPED_TEST(ContactSubsteps, OfALoneBodyAreTheSameInOneLaunch)
{
    expect_the_same_in_one_launch<typename TestFixture::Scene>(this->exec(), {balls()[0]}, 20);
    expect_the_same_in_one_launch<typename TestFixture::Scene>(this->exec(), {balls()[0]}, 21);
}

/// A list of pairs that serves 12 of 30 substeps: `bodies` and points end as after 12.
template<class Scene, class Exec>
void expect_an_early_end(const Exec& exec, const std::vector<BodyState>& bodies)
{
    constexpr double               dt    = 1e-5;
    constexpr std::int32_t         last  = 12;
    const AnalyticShape            shape = sphere_shape(0.05, 40);
    Scene                          one(exec, {shape}, bodies, crowd());
    Scene                          other(exec, {shape}, bodies, crowd());
    dem::DisplacementTracker<Exec> places(exec);
    Array<Exec, double>            allowed(exec, "test displacement allowed");
    Array<Exec, std::int32_t>      numbers(exec, "test substeps of a list", 2);
    one.begin();
    other.begin();
    mark_places(exec, places, one.bodies.view());
    const auto look = [&]
    {
        largest_displacement_ahead(exec, places, one.bodies.view(), one.law().templates, {allowed.data()}, 0,
                                   {2 * dt, 2 * dt});
        return places.share.to_host()[0]; // m
    };
    allowed.assign(std::vector<double>(bodies.size(), 1.0));
    double before = 0, found = 0;
    for (int i = 1; i <= last; ++i)
    {
        contact::substep(exec, one.contact, one.bodies.view(), one.law(), dt);
        move_bodies(exec, one.body_step(dt));
        if (i < last) { before = std::exchange(found, look()); }
    }
    std::vector<double> limits(bodies.size(), 1.0);
    limits[0] = (before + found) / 2; // passed by the look after the substep before the last
    allowed.assign(limits);
    numbers.fill_zero();
    auto step  = other.body_step(dt);
    step.limit = {
        places.listed({allowed.data()}), other.law().templates, dt, 1, 30, numbers.data(), 1, numbers.data() + 1};
    run_substeps(exec, other.contact, other.law(), step, 30);
    EXPECT_EQ(read(exec, numbers.data()), last);
    expect_same("velocity", other.bodies.velocity, one.bodies.velocity);
    expect_same("position", other.bodies.position, one.bodies.position);
    expect_same("place of a point", other.contact.position, one.contact.position);
    expect_same("impulse of a point", other.contact.impulse, one.contact.impulse);
}

TYPED_TEST(ContactSubsteps, EndWithTheLastThatTheListServes)
{
    expect_an_early_end<typename TestFixture::Scene>(this->exec(), balls());
}

/// On a GPU every block looks at its own copy of the body.
TYPED_TEST(ContactSubsteps, OfALoneBodyEndLikewise)
{
    expect_an_early_end<typename TestFixture::Scene>(this->exec(), {balls()[0]});
}

/// No external force acts before the first contact.
TYPED_TEST(ContactSubsteps, BodiesThatMeetNoSandFallFreely)
{
    constexpr double            dt    = 1e-5;
    constexpr int               count = 20, steps = 3;
    typename TestFixture::Scene scene(this->exec(), {sphere_shape(0.05, 40)}, balls(), {{{0.1, 0.1, 0.1}}});
    const auto                  start = scene.bodies.velocity.to_host();
    for (int i = 0; i < steps; ++i)
    {
        scene.begin();
        ASSERT_EQ(scene.contact.candidates.body.size(), 0);
        run_substeps(this->exec(), scene.contact, scene.law(), scene.body_step(dt), count);
        scene.finish();
    }
    const auto   end      = scene.bodies.velocity.to_host();
    const double expected = -9.8 * dt * count * steps;
    for (std::size_t b = 0; b < end.size(); ++b)
    {
        const Vec3<double> gained = end[b] - start[b];
        std::printf("body %zu fell by %.15g m/s, expected %.15g, tolerance 1e-12 of it (rounding of %d sums)\n", b,
                    gained[2], expected, count * steps);
        EXPECT_NEAR(gained[2], expected, 1e-12 * std::fabs(expected));
        EXPECT_EQ(gained[0], 0);
        EXPECT_EQ(gained[1], 0);
    }
    EXPECT_EQ(scene.totals.to_host()[0].sand_work, 0);
}

/// The impulse of sand on bodies equals that of the bodies on their points.
TYPED_TEST(ContactSubsteps, ImpulseOfBodiesIsThatOfTheirSand)
{
    constexpr double            dt    = 1e-5;
    constexpr int               count = 20;
    typename TestFixture::Scene scene(this->exec(), {sphere_shape(0.05, 40)}, balls(), crowd());
    scene.begin();
    const auto start = scene.bodies.velocity.to_host();
    for (int i = 0; i < count; ++i)
    {
        contact::substep(this->exec(), scene.contact, scene.bodies.view(), scene.law(), dt);
        move_bodies(this->exec(), scene.body_step(dt));
    }
    const auto   end    = scene.bodies.velocity.to_host();
    Vec3<double> gained = -2 * count * dt * Vec3<double>(0, 0, -9.8);
    for (std::size_t b = 0; b < end.size(); ++b) { gained += end[b] - start[b]; } // of 1 kg
    Vec3<double> given = Vec3<double>::Zero();
    for (const Vec3<double>& impulse : scene.contact.impulse.to_host()) { given -= impulse; }
    std::printf(
        "impulse on bodies %.6e N s, from their points off by %.1e, tolerance 1e-12 of it (order of the sums)\n",
        gained.norm(), (gained - given).norm() / gained.norm());
    EXPECT_GT(gained.norm(), 1e-4);
    EXPECT_LT((gained - given).norm(), 1e-12 * gained.norm());
}

} // namespace
} // namespace tread::test
