#include "contact_scene.hpp"

#include <cstdio>
#include <random>
#include <set>

#include "kernels/contact/candidates_kern.hpp"

// Candidate search compared with brute force, and its cost if there is nothing to find.
namespace tread::test
{
namespace
{

template<class Case>
class ContactCandidates : public ContactTest<Case>
{
};

TYPED_TEST_SUITE(ContactCandidates, ContactCases, ContactCaseNames);

std::vector<PointState> random_sand(std::size_t count, const Vec3<double>& low, const Vec3<double>& high)
{
    std::mt19937                           random(3);
    std::uniform_real_distribution<double> share(0, 1);
    std::vector<PointState>                sand;
    for (std::size_t i = 0; i < count; ++i)
    {
        const Vec3<double> at(share(random), share(random), share(random));
        sand.push_back({low + at.cwiseProduct(high - low)});
    }
    return sand;
}

std::vector<AnalyticShape> two_shapes() { return {box_shape({0.06, 0.03, 0.015}, 0.03, 48), sphere_shape(0.02, 40)}; }

std::vector<BodyState> moving_bodies()
{
    const Quat turned(Eigen::AngleAxisd(0.7, Vec3<double>(1, 2, 3).normalized()));
    return {{{0.5, 0.5, 0.5}, turned, {3, 0, 1}, {0, 20, 0}, 1.7, 0},
            {{0.62, 0.5, 0.45}, turned, {0, 0, 0}, {0, 0, 0}, 0.5, 1},
            {{0.1, 0.1, 0.9}, turned, {0, 0, 0}, {0, 0, 0}, 1.0, 1},
            {{0.42, 0.5, 0.5}, Quat::Identity(), {0, 0, -5}, {0, 0, 0}, 1.0, 1}};
}

/// Pairs (body, point) whose exact distance is at most r_p + travels * dt * (sum of speeds), from all pairs.
template<class Scene>
std::set<std::pair<int, int>> brute_force(const Scene& scene, const std::vector<AnalyticShape>& shapes,
                                          const std::vector<BodyState>& bodies, double travels)
{
    const std::vector<Vec3<double>> at     = scene.positions();
    const double                    radius = contact::point_radius(scene.numbers.volume, contact::RadiusRule::sphere);
    std::set<std::pair<int, int>>   found;
    for (std::size_t b = 0; b < bodies.size(); ++b)
    {
        const BodyState&     body  = bodies[b];
        const AnalyticShape& shape = shapes[static_cast<std::size_t>(body.shape)];
        const double         speed = body.velocity.norm() + scene.numbers.point_speed +
                             body.angular_velocity.norm() * shape.half.norm() * body.scale;
        for (std::size_t p = 0; p < at.size(); ++p)
        {
            const Vec3<double> local = body.orientation.conjugate() * Vec3<double>(at[p] - body.position);
            if (body.scale * shape.distance(local / body.scale) <= radius + travels * scene.numbers.dt * speed)
            {
                found.emplace(static_cast<int>(b), static_cast<int>(p));
            }
        }
    }
    return found;
}

template<class Set>
std::size_t missing(const Set& wanted, const Set& found)
{
    return static_cast<std::size_t>(
        std::count_if(wanted.begin(), wanted.end(), [&](const auto& pair) { return found.count(pair) == 0; }));
}

/// Candidates as pairs, after checking their order and both sets of runs.
template<class Scene>
std::set<std::pair<int, int>> checked_candidates(const Scene& scene)
{
    const auto& c       = scene.contact.candidates;
    const auto  body    = c.body.to_host();
    const auto  point   = c.point.to_host();
    const auto  touched = c.touched.to_host(), in_order = c.in_order.to_host();
    const auto  body_key = c.by_body.key.to_host(), body_first = c.by_body.first.to_host();
    const auto  point_key = c.by_point.key.to_host(), point_first = c.by_point.first.to_host();

    std::set<std::pair<int, int>> found;
    for (std::size_t i = 0; i < body.size(); ++i)
    {
        EXPECT_TRUE(i == 0 || body[i - 1] <= body[i]);
        EXPECT_TRUE(found.emplace(body[i], point[i]).second) << "twice: body " << body[i] << " point " << point[i];
        EXPECT_EQ(point_key[static_cast<std::size_t>(touched[i])], point[i]);
    }
    const auto covered = [&](const auto& key, const auto& first, auto value)
    {
        for (std::size_t run = 0; run < key.size(); ++run)
        {
            EXPECT_TRUE(run == 0 || key[run - 1] < key[run]);
            EXPECT_LT(first[run], first[run + 1]);
            for (auto i = first[run]; i < first[run + 1]; ++i)
            {
                EXPECT_EQ(value(static_cast<std::size_t>(i)), key[run]);
            }
        }
        EXPECT_EQ(static_cast<std::size_t>(first[key.size()]), body.size());
    };
    covered(body_key, body_first, [&](std::size_t i) { return body[i]; });
    covered(point_key, point_first, [&](std::size_t i) { return point[static_cast<std::size_t>(in_order[i])]; });
    for (std::size_t i = 1; i < in_order.size(); ++i)
    {
        const auto a = static_cast<std::size_t>(in_order[i - 1]), b = static_cast<std::size_t>(in_order[i]);
        EXPECT_TRUE(point[a] < point[b] || body[a] < body[b]) << "bodies of one point in order";
    }
    return found;
}

TYPED_TEST(ContactCandidates, NoneIsMissed)
{
    const auto   shapes = two_shapes();
    const auto   bodies = moving_bodies();
    const auto   sand   = random_sand(60000, {0.35, 0.35, 0.35}, {0.7, 0.65, 0.65});
    SceneNumbers numbers;
    numbers.dt = 5e-4;
    typename TestFixture::Scene scene(this->exec(), shapes, bodies, sand, numbers);
    scene.find();

    const auto found    = checked_candidates(scene);
    const auto expected = brute_force(scene, shapes, bodies, 1);
    const auto reached  = brute_force(scene, shapes, bodies, 2);
    std::printf("[ measured ] %zu candidates; %zu can touch in the step, of which %zu missed; %zu within twice that\n",
                found.size(), expected.size(), missing(expected, found), reached.size());
    EXPECT_GT(expected.size(), 1000u);
    EXPECT_EQ(missing(expected, found), 0u);
    // The search keeps points within twice the displacement; 5 % more because the sampled distance is slightly low at
    // edges.
    EXPECT_LE(found.size(), reached.size() + reached.size() / 20);
}

/// A pile of a thousand rocks in sand, some much smaller than a cell and some touching each other.
TYPED_TEST(ContactCandidates, NoneIsMissedInAPileOfAThousandBodies)
{
    std::mt19937                           random(8);
    std::uniform_real_distribution<double> share(0, 1);
    const auto                             shift = [&](double most) -> Vec3<double> {
        return {most * share(random), most * share(random), most * share(random)};
    };
    std::vector<BodyState> bodies;
    for (int i = 0; i < 1000; ++i)
    {
        const Vec3<double> place = 0.04 * Vec3<double>(i % 10, i / 10 % 10, i / 100);
        const Quat         turned(Eigen::AngleAxisd(6 * share(random), (shift(2) - Vec3<double>::Ones()).normalized()));
        bodies.push_back({Vec3<double>(0.3, 0.3, 0.3) + place + shift(0.02), turned, shift(2), shift(50),
                          0.2 + 0.6 * share(random), i % 2});
    }
    const auto                  shapes = two_shapes();
    typename TestFixture::Scene scene(this->exec(), shapes, bodies,
                                      random_sand(30000, {0.28, 0.28, 0.28}, {0.72, 0.72, 0.72}));
    scene.find();

    const auto found = checked_candidates(scene), expected = brute_force(scene, shapes, bodies, 1);
    std::printf("[ measured ] %zu candidates; %zu can touch in the step, of which %zu missed\n", found.size(),
                expected.size(), missing(expected, found));
    EXPECT_GT(expected.size(), 10000u);
    EXPECT_EQ(missing(expected, found), 0u);
}

TYPED_TEST(ContactCandidates, NoneIsMissedWherePointsHaveLeftTheirCells)
{
    const auto   shapes = two_shapes();
    const auto   bodies = moving_bodies();
    SceneNumbers numbers;
    numbers.point_drift = 0.008;
    typename TestFixture::Scene            scene(this->exec(), shapes, bodies,
                                                 random_sand(20000, {0.35, 0.35, 0.35}, {0.7, 0.65, 0.65}), numbers);
    auto                                   moved = scene.points.position.to_host();
    std::mt19937                           random(4);
    std::uniform_real_distribution<double> shift(-0.008, 0.008);
    for (double& x : moved) { x += shift(random); }
    scene.points.position.assign(moved);
    scene.find();

    const auto expected = brute_force(scene, shapes, bodies, 1);
    EXPECT_GT(expected.size(), 300u);
    EXPECT_EQ(missing(expected, checked_candidates(scene)), 0u);
}

/// Expects that no contact is missed when the bodies are moved by their ways (m) in any of 20 random directions;
/// returns the number of contacts.
template<class Scene>
std::size_t none_missed_after(Scene& scene, const std::vector<AnalyticShape>& shapes,
                              const std::vector<BodyState>& bodies, const std::vector<double>& ways,
                              const std::set<std::pair<int, int>>& found)
{
    scene.numbers.dt = 0; // then only touching pairs are found, wherever the bodies have moved
    std::mt19937                     random(6);
    std::normal_distribution<double> normal;
    std::size_t                      touching = 0;
    for (int way = 0; way < 20; ++way)
    {
        auto moved = bodies;
        for (std::size_t b = 0; b < moved.size(); ++b)
        {
            const Vec3<double> aside(normal(random), normal(random), normal(random));
            moved[b].position += ways[b] * aside.normalized();
        }
        const auto expected = brute_force(scene, shapes, moved, 1);
        touching += expected.size();
        EXPECT_EQ(missing(expected, found), 0u);
    }
    std::printf("[ measured ] %zu candidates, %zu contacts in 20 places, none missed\n", found.size(), touching);
    return touching;
}

std::vector<PointState> sand_around() { return random_sand(20000, {0.35, 0.35, 0.35}, {0.7, 0.65, 0.65}); }

SceneNumbers with_a_skin()
{
    SceneNumbers numbers;
    numbers.dt   = 1e-5;
    numbers.skin = 0.004;
    return numbers;
}

/// A list with a skin is valid for later steps: bodies and points may approach by half of it in total. The other half
/// accounts for the field, which between its nodes is steeper than a distance, as in a single step.
TYPED_TEST(ContactCandidates, NoneIsMissedUntilTheSkinIsUsedUp)
{
    const auto                  bodies = moving_bodies();
    typename TestFixture::Scene scene(this->exec(), two_shapes(), bodies, sand_around(), with_a_skin());
    scene.find();
    const auto found = checked_candidates(scene);

    const std::vector<double> ways(bodies.size(), 0.5 * scene.numbers.skin);
    const std::size_t         touching = none_missed_after(scene, two_shapes(), bodies, ways, found);
    EXPECT_GT(touching, 2000u);
}

/// Candidates found beside a list of pairs hold while each body goes no further from its place in that list than the
/// list allows it, and points use up the skin: bodies have gone a quarter of that before the search.
TYPED_TEST(ContactCandidates, NoneIsMissedUntilAListExpires)
{
    const auto                  bodies = moving_bodies();
    typename TestFixture::Scene scene(this->exec(), two_shapes(), bodies, sand_around(), with_a_skin());

    const std::vector<double> allowed{0.003, 0.012, 0.02, 0.001};
    using Exec = typename TypeParam::Exec;
    Array<Exec, Vec3<double>> position(this->exec(), "test listed positions");
    Array<Exec, Quat>         orientation(this->exec(), "test listed orientations");
    Array<Exec, double>       allowance(this->exec(), "test allowed displacements");
    std::vector<Vec3<double>> places;
    std::vector<Quat>         turned;
    std::vector<double>       ways;
    for (std::size_t b = 0; b < bodies.size(); ++b)
    {
        places.push_back(bodies[b].position + Vec3<double>(0.25 * allowed[b], 0, 0));
        turned.push_back(bodies[b].orientation);
        ways.push_back(1.25 * allowed[b] + 0.5 * scene.numbers.skin);
    }
    position.assign(places);
    orientation.assign(turned);
    allowance.assign(allowed);
    scene.listed = {position.data(), orientation.data(), {allowance.data()}};
    scene.find();
    const auto        found    = checked_candidates(scene);
    const std::size_t touching = none_missed_after(scene, two_shapes(), bodies, ways, found);
    EXPECT_GT(touching, 2000u);
}

TYPED_TEST(ContactCandidates, FarBodyCostsOnlyTheCount)
{
    typename TestFixture::Scene scene(this->exec(), {sphere_shape(0.02, 20)}, {{{0.5, 0.5, 0.9}}},
                                      random_sand(2000, {0.1, 0.1, 0.1}, {0.4, 0.4, 0.2}));
    const auto                  before = this->counters.launches();
    scene.begin();
    scene.substep(1e-4);
    scene.finish();
    EXPECT_EQ(scene.contact.candidates.body.size(), 0);
    const std::set<std::string> counting{"count contact pages", "find contact pages", "scan"};
    for (const auto& [name, launches] : this->counters.launches())
    {
        const auto old = before.find(name);
        if (old == before.end() || old->second != launches) { EXPECT_TRUE(counting.count(name)) << name; }
    }
    EXPECT_EQ(scene.summary().live, 0);
}

TYPED_TEST(ContactCandidates, BodyAnywhereIsSearchedSafely)
{
    const double                nan = std::numeric_limits<double>::quiet_NaN();
    typename TestFixture::Scene scene(
        this->exec(), {sphere_shape(0.02, 20)},
        {{{1e12, -1e12, 0.5}}, {{nan, 0, 0}}, {{0.2, 0.2, 0.15}, Quat::Identity(), {1e9, 0, 0}}},
        random_sand(2000, {0.1, 0.1, 0.1}, {0.4, 0.4, 0.2}));
    scene.find();
    const auto bodies = scene.contact.candidates.body.to_host();
    EXPECT_EQ(std::count(bodies.begin(), bodies.end(), 0), 0);
    EXPECT_EQ(std::count(bodies.begin(), bodies.end(), 2), 2000) << "a body that fast may touch every point";
}

} // namespace
} // namespace tread::test
