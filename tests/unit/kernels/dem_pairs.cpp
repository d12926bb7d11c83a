#include <algorithm>
#include <cmath>
#include <vector>

#include "base/random.hpp"
#include "dem_scene.hpp"
#include "kernels/dem/pairs/displacement_tracker.hpp"

namespace tread::test
{
namespace
{

template<class Exec>
class BodyPairs : public DemTest<Exec>
{
};
TYPED_TEST_SUITE(BodyPairs, Backends, BackendNames);

constexpr double step = 1e-3;

/// Spheres of 1 to 3 cm in a box of half a metre, a few much larger, some fast, some outside the domain.
std::vector<Solid> crowd(int count)
{
    Random     random(5);
    const auto anywhere = [&]
    { return Vec3<double>(random.uniform(-0.1, 0.5), random.uniform(-0.1, 0.5), random.uniform(0, 0.4)); };
    std::vector<Solid> solids;
    for (int i = 0; i < count; ++i)
    {
        const bool large = i % 150 == 149;
        Solid solid = solid_sphere(large ? random.uniform(0.12, 0.2) : random.uniform(0.005, 0.015), 1000, anywhere());
        if (i % 10 == 0) { solid.velocity = 20 * anywhere(); }
        if (i % 17 == 0) { solid.spin = 300 * anywhere(); }
        solids.push_back(solid);
    }
    solids[0].position = {1e9, 0, 0};
    solids[1].position = {1e9 + 0.01, 0, 0};
    return solids;
}

/// Displacement (m) of its fastest point in a step.
double way_of(const Solid& solid) { return step * (solid.velocity.norm() + solid.spin.norm() * solid.scale); }

/// Allowed displacement per step of a sphere's list, in radii.
double step_of(const Solid& solid) { return std::min(way_of(solid) / solid.scale, 0.2); }

/// Number of steps beyond the first for which the list of a step of one substep is valid.
double steps_of(const std::vector<Solid>& solids)
{
    double sum = 0;
    for (const Solid& solid : solids) { sum += step_of(solid); }
    const double mean = sum / static_cast<double>(solids.size());
    return std::min({std::max(std::sqrt(1.5 / mean) - 1, 0.0), 0.01 / mean, 60.0});
}

/// Radius that find_pairs guarantees for exact spheres, whose bounding sphere is their surface
/// (dem::search_displacement).
double grown(const Solid& solid, double steps)
{
    return solid.scale + 2.1 * way_of(solid) + (0.003 + std::min(steps * step_of(solid), 0.2)) * solid.scale;
}

std::vector<std::uint64_t> brute_force(const std::vector<Solid>& solids, const std::vector<dem::Plane>& planes)
{
    std::vector<std::uint64_t> keys;
    const auto                 count = static_cast<std::int64_t>(solids.size());
    const double               steps = steps_of(solids);
    for (std::int64_t a = 0; a < count; ++a)
    {
        const Solid& first = solids[static_cast<std::size_t>(a)];
        for (std::int64_t b = a + 1; b < count; ++b)
        {
            const Solid& second = solids[static_cast<std::size_t>(b)];
            if ((first.position - second.position).norm() <= grown(first, steps) + grown(second, steps))
            {
                keys.push_back(dem::pair_key(a, b));
            }
        }
        for (std::size_t p = 0; p < planes.size(); ++p)
        {
            if (planes[p].normal.dot(first.position) - planes[p].offset <= grown(first, steps))
            {
                keys.push_back(dem::pair_key(a, count + static_cast<std::int64_t>(p)));
            }
        }
    }
    return keys;
}

TYPED_TEST(BodyPairs, AllowForLessWhereAllBodiesMove)
{
    const Vec3<double> velocity{3, 4, 0};
    std::vector<Solid> solids;
    for (int i = 0; i < 50; ++i)
    {
        solids.push_back(solid_sphere(0.01, 1000, {1.0 * i, 0, 0}));
        solids.back().velocity = velocity;
    }
    typename TestFixture::Scene scene(this->exec(), {exact_sphere()}, solids, {});
    scene.find(step);
    const double way = step * velocity.norm(), all = 2.1 * way + 0.003 * 0.01 + 0.01 * 0.01;
    double       worst = 0;
    for (const double allowed : scene.pairs.displacement.allowed.to_host())
    {
        worst = std::max(worst, std::abs(allowed / all - 1));
    }
    std::printf("lists allow for %.3e m, differing by %.1e; tolerance 1e-12 (order of a sum)\n", all, worst);
    EXPECT_LT(worst, 1e-12);
}

/// The number of steps that minimises the cost of 1000 substeps and their share of a search: sqrt(1.5 / (N way / R)) -
/// 1.
TYPED_TEST(BodyPairs, LastFewerStepsWhereSubstepsAreMany)
{
    constexpr double   radius = 0.01, way = 1e-4 * radius;
    std::vector<Solid> solids;
    for (int i = 0; i < 50; ++i)
    {
        solids.push_back(solid_sphere(radius, 1000, {1.0 * i, 0, 0}));
        solids.back().velocity = {way / step, 0, 0};
    }
    typename TestFixture::Scene scene(this->exec(), {exact_sphere()}, solids, {});
    scene.find(step, 1000);
    const double all   = (2.1 + std::sqrt(1.5 / (1000 * 1e-4)) - 1) * way + 0.003 * radius;
    double       worst = 0;
    for (const double allowed : scene.pairs.displacement.allowed.to_host())
    {
        worst = std::max(worst, std::abs(allowed / all - 1));
    }
    std::printf("lists allow for %.3e m, differing by %.1e; tolerance 1e-12 (order of a sum)\n", all, worst);
    EXPECT_LT(worst, 1e-12);
}

/// Spheres at rest in a row, of which the fifth is about to be hit by the sixth.
std::vector<Solid> row_with_a_hit(double radius, double speed)
{
    std::vector<Solid> solids;
    for (int i = 0; i < 20; ++i) { solids.push_back(solid_sphere(radius, 1000, {0.1 * i, 0, 0})); }
    solids[5].position = solids[4].position + Vec3<double>(2 * radius, 0, 0);
    solids[5].velocity = {-speed, 0, 0};
    return solids;
}

/// A body at rest may soon be as fast as a moving one that is about to hit it.
TYPED_TEST(BodyPairs, AllowForTheMotionOfNeighboursInTheLastList)
{
    constexpr double            radius = 0.01, speed = 0.005;
    typename TestFixture::Scene scene(this->exec(), {exact_sphere()}, row_with_a_hit(radius, speed), {});
    const double                rest = 0.003 * radius, more = 60 * step * speed;
    scene.find(step);
    EXPECT_NEAR(scene.pairs.displacement.allowed.to_host()[4], rest, 1e-12 * rest);
    scene.find(step);
    const std::vector<double> allowed = scene.pairs.displacement.allowed.to_host();
    EXPECT_NEAR(allowed[3], rest, 1e-12 * rest);
    EXPECT_NEAR(allowed[4], rest + more, 1e-12 * more);
    EXPECT_NEAR(allowed[5], rest + 2.1 * step * speed + more, 1e-12 * more);
}

/// So many substeps make lists last for no further step: what is hit in this one is allowed its way all the same.
TYPED_TEST(BodyPairs, AllowForAHitWithinTheStep)
{
    constexpr double            radius = 0.01, way = 0.1 * radius;
    typename TestFixture::Scene scene(this->exec(), {exact_sphere()}, row_with_a_hit(radius, way / step), {});
    scene.find(step, 1000);
    scene.find(step, 1000);
    const std::vector<double> allowed = scene.pairs.displacement.allowed.to_host();
    const double              rest    = 0.003 * radius;
    EXPECT_NEAR(allowed[3], rest, 1e-12 * way);
    EXPECT_NEAR(allowed[4], rest + way, 1e-12 * way);
    EXPECT_NEAR(allowed[5], rest + 2.1 * way, 1e-12 * way);
}

TYPED_TEST(BodyPairs, AreThoseOfBruteForce)
{
    const std::vector<Solid> solids = crowd(900);
    SolidNumbers             numbers;
    numbers.planes = {{{0, 0, 1}, 0.0, false}, {{-1, 0, 0}, -0.5, true}};
    typename TestFixture::Scene scene(this->exec(), {exact_sphere()}, solids, numbers);
    scene.find(step);
    const std::vector<std::uint64_t> expected = brute_force(solids, numbers.planes);
    EXPECT_GT(expected.size(), 500u);
    EXPECT_EQ(scene.pairs.sizes.large.size(), 6);
    EXPECT_EQ(scene.pairs.key.to_host(), expected);
}

/// Pairs that may touch while bodies drift and are displaced from there as the list allows it.
template<class Scene>
std::vector<std::uint64_t> brute_force_of_drifts(const Scene& scene, const std::vector<Solid>& solids)
{
    const auto   allowed = scene.pairs.displacement.allowed.to_host();
    const auto   drift   = scene.pairs.displacement.drift.to_host();
    const double span    = scene.pairs.displacement.span.to_host()[0];

    std::vector<std::uint64_t> keys;
    for (std::size_t a = 0; a < solids.size(); ++a)
    {
        for (std::size_t b = a + 1; b < solids.size(); ++b)
        {
            const double together = solids[a].scale + solids[b].scale + allowed[a] + allowed[b];
            const double apart    = (solids[a].position - solids[b].position).norm();
            if (apart <= together + span * (drift[a] - drift[b]).norm())
            {
                keys.push_back(dem::pair_key(static_cast<std::int64_t>(a), static_cast<std::int64_t>(b)));
            }
        }
    }
    return keys;
}

/// Spheres that lie, and as many above them that fall.
std::vector<Solid> falling_bed()
{
    constexpr double   radius = 0.01, speed = 1.5;
    Random             random(8);
    std::vector<Solid> solids;
    for (int i = 0; i < 1200; ++i)
    {
        const bool         falls = i % 2 == 0;
        const double       above = falls ? 0.2 : 0.0;
        const Vec3<double> at(random.uniform(0, 0.4), random.uniform(0, 0.4), above + random.uniform(0, 0.2));
        solids.push_back(solid_sphere(radius, 1000, at));
        if (falls) { solids.back().velocity = {0, 0, -speed - 0.1 * random.uniform(0, 1)}; }
    }
    return solids;
}

/// Rocks drift that have none of the other bed near them, and the list has but the pairs that may touch.
TYPED_TEST(BodyPairs, OfAFallingBedAreThoseThatMayComeTogether)
{
    const std::vector<Solid>    solids = falling_bed();
    typename TestFixture::Scene scene(this->exec(), {exact_sphere()}, solids, {});
    scene.find(step);
    const auto all = scene.pairs.key.size(); // without neighbours in a last list nothing is known of who goes along
    EXPECT_FALSE(scene.pairs.displacement.drifting);
    scene.find(step);
    EXPECT_TRUE(scene.pairs.displacement.drifting);

    const auto   drift    = scene.pairs.displacement.drift.to_host();
    const auto   keys     = scene.pairs.key.to_host();
    std::int64_t drifting = 0;
    for (std::size_t b = 0; b < solids.size(); ++b)
    {
        drifting += drift[b].norm() > 0 ? 1 : 0;
        EXPECT_TRUE(drift[b].norm() == 0 || drift[b] == solids[b].velocity);
        if (drift[b].norm() > 0) { EXPECT_EQ(b % 2, 0u); }
    }
    std::printf("%lld of 600 falling bodies drift, at least 300 expected; %lld pairs, %lld without drifts\n",
                static_cast<long long>(drifting), static_cast<long long>(keys.size()), static_cast<long long>(all));
    EXPECT_GE(drifting, 300);
    EXPECT_LT(static_cast<std::int64_t>(keys.size()), all);
    EXPECT_EQ(keys, brute_force_of_drifts(scene, solids));
}

/// Bodies that keep their velocity are not displaced from where they drift to; the list ends with the time for which
/// they may.
TYPED_TEST(BodyPairs, ThatDriftEndWithTheirTime)
{
    const std::vector<Solid>    solids = falling_bed();
    typename TestFixture::Scene scene(this->exec(), {exact_sphere()}, solids, {});
    scene.find(step);
    scene.find(step);
    dem::DisplacementTracker<TypeParam> places(this->exec());
    mark_places(this->exec(), places, scene.bodies.view());
    for (int i = 0; i < 10; ++i) { scene.move(0.1 * step); }

    const dem::AllowedMotion allowed = scene.pairs.displacement.view();
    const double             span    = scene.pairs.displacement.span.to_host()[0];
    const auto               share   = [&](double age, double ahead)
    {
        return read(this->exec(), largest_displacement_ahead(this->exec(), places, scene.bodies.view(),
                                                             scene.law().templates, allowed, age, {0, ahead}));
    };
    const double displaced = read(this->exec(), largest_displacement(this->exec(), places, scene.bodies.view(),
                                                                     scene.law().templates, allowed, 0)),
                 along = share(step, 0), later = share(step, (span - step) / 2.1 * (1 + 1e-9));
    std::printf(
        "share of what is allowed: %.3f beside drifts, %.1f from the old place, %.9f at the end of their time\n", along,
        displaced, later);
    EXPECT_LT(along, 1);
    EXPECT_GT(displaced, 1);
    EXPECT_GT(later, 1);
    EXPECT_LT(later, 1 + 1e-6);
}

/// Memory of the search, except the list, is released for the substeps; a later list of the same pairs has the capacity
/// of the last one.
TYPED_TEST(BodyPairs, LeaveNothingOfTheSearchBehind)
{
    typename TestFixture::Scene scene(this->exec(), {exact_sphere()}, crowd(900), {});
    scene.find(step);
    scene.find(step); // by the motion of neighbours in the last list
    const std::int64_t held = this->counters.current_bytes();
    scene.find(step);
    scene.find(step); // who drifts depends on the last list, and is the same with every second
    EXPECT_EQ(this->counters.current_bytes(), held);
    for (const char* name :
         {"body search radii", "body speeds", "body speeds beside drifts", "body displacement a step more",
          "body cells", "bodies by cell", "body search spheres", "pairs found", "pairs accepted", "placed nodes",
          "near clusters", "pairs counted", "sort scratch"})
    {
        EXPECT_EQ(this->counters.bytes().find(name)->second, 0) << name;
    }
    EXPECT_GT(scene.pairs.key.size(), 500);
    EXPECT_EQ(scene.pairs.last.key.capacity(), 0);
    EXPECT_EQ(scene.pairs.last.patch.capacity(), 0);
}

TYPED_TEST(BodyPairs, KnowThePairsOfEachBody)
{
    const std::vector<Solid>    solids = crowd(300);
    typename TestFixture::Scene scene(this->exec(), {exact_sphere()}, solids, {});
    scene.find(step);
    const auto keys  = scene.pairs.key.to_host();
    const auto first = scene.pairs.of_body.first.to_host(), second = scene.pairs.of_body.second.to_host();
    const auto by_second = scene.pairs.of_body.by_second.to_host();
    std::vector<std::int32_t> expected;
    for (std::size_t b = 0; b < solids.size(); ++b)
    {
        expected.clear();
        for (std::size_t p = 0; p < keys.size(); ++p)
        {
            if (dem::second_of(keys[p]) == static_cast<std::int64_t>(b))
            {
                expected.push_back(static_cast<std::int32_t>(p));
            }
        }
        const std::vector<std::int32_t> found(by_second.begin() + second[b], by_second.begin() + second[b + 1]);
        EXPECT_EQ(found, expected);
        for (std::int32_t p = first[b]; p < first[b + 1]; ++p)
        {
            EXPECT_EQ(dem::first_of(keys[static_cast<std::size_t>(p)]), static_cast<std::int64_t>(b));
        }
    }
}

TYPED_TEST(BodyPairs, KeepTheirPatchWhileListed)
{
    std::vector<Solid>          solids = crowd(300);
    typename TestFixture::Scene scene(this->exec(), {exact_sphere()}, solids, {});
    scene.find(step);
    const auto              before = scene.pairs.key.to_host();
    std::vector<dem::Patch> patches(before.size(), dem::no_patch());
    for (std::size_t p = 0; p < before.size(); ++p) { patches[p].torsion = static_cast<double>(p + 1); }
    scene.pairs.patch.assign(patches);

    for (Solid& solid : solids) { solid.position[0] += 0.02 * std::sin(100 * solid.position[1]); }
    std::vector<Vec3<double>> moved;
    for (const Solid& solid : solids) { moved.push_back(solid.position); }
    scene.bodies.position.assign(moved);
    scene.find(step);

    const auto after = scene.pairs.key.to_host();
    patches          = scene.pairs.patch.to_host();
    std::size_t kept = 0, fresh = 0;
    for (std::size_t p = 0; p < after.size(); ++p)
    {
        const auto at  = std::lower_bound(before.begin(), before.end(), after[p]);
        const bool old = at != before.end() && *at == after[p];
        EXPECT_EQ(patches[p].torsion, old ? static_cast<double>(at - before.begin() + 1) : 0.0);
        ++(old ? kept : fresh);
    }
    EXPECT_GT(kept, 50u);
    EXPECT_GT(fresh, 10u);
    EXPECT_GT(before.size() - kept, 10u);
}

} // namespace
} // namespace tread::test
