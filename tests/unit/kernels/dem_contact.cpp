#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "base/random.hpp"
#include "dem_scene.hpp"

namespace tread::test
{
namespace dem_contact_test
{

template<class Exec>
class BodyContact : public DemTest<Exec>
{
};
TYPED_TEST_SUITE(BodyContact, Backends, BackendNames);

constexpr double radius = 0.2, density = 2000, speed = 1;

/// Two spheres of docs/verification.md#hertz-impact at 1 m/s each along a direction, just separated.
std::vector<Solid> head_on(const Vec3<double>& direction)
{
    const Vec3<double> n     = direction.normalized();
    Solid              first = solid_sphere(radius, density, -1.001 * radius * n), second = first;
    second.position = -first.position;
    first.velocity  = speed * n;
    second.velocity = -speed * n;
    return {first, second};
}

struct Collision
{
    double largest_force = 0;
    double rebound       = 0; ///< m/s, along the direction
    double momentum      = 0; ///< N s, error
    double energy        = 0; ///< after over before
    double ledger        = 0; ///< energy after and losses over energy before
};

template<class Scene>
Collision collide(Scene& scene, const Vec3<double>& direction)
{
    constexpr double dt = 2e-5, duration = 0.04; // contact lasts 32.5 ms (A1)
    Collision        found;
    const double     before = scene.sums().kinetic;
    for (int step = 0; step < static_cast<int>(duration / dt); step += 10)
    {
        scene.run(dt, 10, 10);
        found.largest_force = std::max(found.largest_force, scene.bodies.force.to_host()[0].norm());
    }
    const dem::BodySums after = scene.sums();
    found.rebound             = scene.bodies.velocity.to_host()[1].dot(direction.normalized());
    found.momentum            = after.momentum.norm();
    found.energy              = after.kinetic / before;
    found.ledger              = (after.kinetic + after.total.restitution + after.total.friction) / before;
    return found;
}

Quat random_turn(Random& random)
{
    const auto part = [&] { return random.uniform(-1, 1); };
    return Quat(part(), part(), part(), part()).normalized();
}

struct ForceAndEnergy
{
    double force, energy;
};

/// The traction law on two exact spheres at a centre distance of 2 R - approach, by quadrature over one of them.
ForceAndEnergy exact_spheres(double approach)
{
    const dem::PairLaw law      = dem::pair_law(properties(1e7, 0.3, 2, 0, 0), {1.0, 1e-3}, 2 / radius, 1.0);
    const double       distance = 2 * radius - approach, edge = std::acos(0.5 * distance / radius);
    constexpr int      rings = 2000;
    ForceAndEnergy     sum{0, 0};
    for (int i = 0; i < rings; ++i)
    {
        const double        angle = (i + 0.5) / rings * edge, along = distance - radius * std::cos(angle);
        const double        to_centre = std::hypot(along, radius * std::sin(angle));
        const double        area      = 2 * std::numbers::pi * radius * radius * std::sin(angle) * edge / rings;
        const dem::Traction at        = dem::traction_at(law, radius - to_centre);
        sum.force += at.pressure * area * along / to_centre;
        sum.energy += at.energy * area;
    }
    return sum;
}

/// Largest force of the head-on case, where all kinetic energy is in the contact.
double exact_largest_force()
{
    const double energy = solid_sphere(radius, density, Vec3<double>::Zero()).mass * speed * speed;
    double       low = 0, high = radius;
    for (int bisection = 0; bisection < 60; ++bisection)
    {
        const double middle                                  = 0.5 * (low + high);
        (exact_spheres(middle).energy < energy ? low : high) = middle;
    }
    return exact_spheres(low).force;
}

TYPED_TEST(BodyContact, HeadOnSpheresApproachHertzWithTheirNodes)
{
    constexpr double hertz = 7593.4; // F_max, A1
    constexpr int    turns = 12;
    // Hertz approximates the spheres by paraboloids; at an overlap of 11 % of R the traction law on exact spheres is
    // 2.1 % below. Single orientations scatter about it, because a patch of radius 47 mm is 2 and 9 nodes wide.
    const double limit = exact_largest_force();
    std::printf("Hertz %.1f N, the law on exact spheres %.1f N (%+.2f %%)\n", hertz, limit, 100 * (limit / hertz - 1));
    EXPECT_NEAR(limit, hertz, 0.022 * hertz);
    for (const auto& [level, tolerance] : {std::pair{2, 0.03}, std::pair{3, 0.01}})
    {
        const SolidShape   sphere = unit_sphere(level, 64);
        const Vec3<double> direction(0.3, -0.5, 0.8);
        Random             random(11);
        double             mean = 0, low = 1e9, high = 0;
        for (int turn = 0; turn < turns; ++turn)
        {
            std::vector<Solid> solids = head_on(direction);
            for (Solid& solid : solids) { solid.orientation = random_turn(random); }
            typename TestFixture::Scene scene(this->exec(), {sphere}, solids, {});
            const Collision             found = collide(scene, direction);
            mean += found.largest_force / turns;
            low  = std::min(low, found.largest_force);
            high = std::max(high, found.largest_force);
            EXPECT_NEAR(found.energy, 1, 1e-4); // dt is a 1600th of the contact
            EXPECT_LT(found.momentum, 1e-10);
        }
        std::printf("%zu nodes: mean F_max of %d orientations %.1f N (%.0f to %.0f), expected %.1f N: %+.2f %%, "
                    "tolerance %.0f %% (3 standard errors)\n",
                    sphere.positions.size(), turns, mean, low, high, limit, 100 * (mean / limit - 1), 100 * tolerance);
        EXPECT_NEAR(mean, limit, tolerance * limit);
    }
}

TYPED_TEST(BodyContact, RestitutionIsTheOneAskedFor)
{
    constexpr double wanted = 0.5;
    SolidNumbers     numbers;
    numbers.zeta = damping_ratio(wanted);
    const Vec3<double>          direction(0.3, -0.5, 0.8);
    typename TestFixture::Scene scene(this->exec(), {unit_sphere(3, 40)}, head_on(direction), numbers);
    const Collision             found = collide(scene, direction);
    std::printf("restitution %.3f, expected %.3f, tolerance 0.07 (docs/verification.md#restitution: shapes and counts "
                "spread 0.54-0.61 "
                "about 0.558), ledger %+.1e\n",
                found.rebound, wanted, found.ledger - 1);
    EXPECT_NEAR(found.rebound / speed, wanted, 0.07);
    EXPECT_NEAR(found.ledger, 1, 2e-3);
}

/// Boxes in off-centre collisions with arbitrary orientations: corners and edges in faces.
std::vector<Solid> off_centre_boxes()
{
    Solid first;
    first.mass         = 20;
    first.inertia      = Vec3<double>(0.3, 0.25, 0.2).asDiagonal();
    first.orientation  = Quat(Eigen::AngleAxisd(0.9, Vec3<double>(1, 2, 3).normalized()));
    first.velocity     = {1, 0.1, 0};
    first.spin         = {0.5, -1, 0.3};
    Solid second       = first;
    second.position    = {0.31, 0.06, 0.03};
    second.orientation = Quat(Eigen::AngleAxisd(2.1, Vec3<double>(-2, 1, 0.5).normalized()));
    second.velocity    = {-1, 0, 0.2};
    second.mass        = 10;
    second.inertia *= 0.5;
    return {first, second};
}

TYPED_TEST(BodyContact, OffCentreImpactKeepsMomentumSpinAndEnergy)
{
    for (const double friction : {0.0, 0.4})
    {
        SolidNumbers numbers;
        numbers.friction = friction;
        typename TestFixture::Scene scene(this->exec(), {box_solid({0.08, 0.1, 0.12}, 10, 40)}, off_centre_boxes(),
                                          numbers);
        const dem::BodySums         before = scene.sums();
        double                      peak   = 0;
        for (int block = 0; block < 100; ++block)
        {
            scene.run(1e-5, 100);
            peak = std::max(peak, scene.sums().contact);
        }
        const dem::BodySums after   = scene.sums();
        const double        balance = after.kinetic + after.total.friction - before.kinetic;
        std::printf("friction %.1f: energy that changed hands %.3f J, lost to friction %.3f J, unaccounted %.1e of it "
                    "(tolerance 2e-3: first-order step)\n",
                    friction, peak, after.total.friction, balance / peak);
        std::printf("  momentum error %.1e N s, spin error %.1e N m s (rounding)\n",
                    (after.momentum - before.momentum).norm(), (after.spin - before.spin).norm());
        EXPECT_GT(peak, 1.0);
        EXPECT_EQ(after.contact, 0);
        EXPECT_LT((after.momentum - before.momentum).norm(), 1e-11);
        EXPECT_LT((after.spin - before.spin).norm(), 1e-11);
        EXPECT_LT(std::abs(balance), 2e-3 * peak);
        EXPECT_EQ(after.total.friction > 0.01, friction > 0);
    }
}

/// Boxes and spheres with nodes about a decimetre apart, fast enough to collide within the time.
std::vector<Solid> fast_pair(Random& random)
{
    const auto anywhere = [&](double size) -> Vec3<double>
    { return size * Vec3<double>(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)); };
    std::vector<Solid> solids;
    for (int i = 0; i < 2; ++i)
    {
        Solid solid       = solid_sphere(0.1, 2000, anywhere(0.12));
        solid.shape       = random.uniform(0, 1) < 0.5 ? 0 : 1;
        solid.orientation = random_turn(random);
        solid.velocity    = anywhere(2);
        solid.spin        = anywhere(10);
        solids.push_back(solid);
    }
    return solids;
}

TYPED_TEST(BodyContact, NoNodeIsMissedByTheList)
{
    constexpr double dt = 2e-3;
    Random           random(3);
    SolidShape       box = box_solid({0.8, 1, 1.2}, 10, 40);
    const dem::Plane ground{{0, 0, 1}, -0.15, false};
    int              touching = 0;
    std::int64_t     listed = 0, all = 0;
    double           worst = 0;
    for (int trial = 0; trial < 200; ++trial)
    {
        SolidNumbers numbers;
        numbers.planes = {ground};
        typename TestFixture::Scene scene(this->exec(), {unit_sphere(3, 40), box}, fast_pair(random), numbers);
        scene.find(dt);
        scene.move(dt);
        scene.contact(dt);
        const auto from_list = scene.bodies.force.to_host();
        listed += scene.pairs.nodes.node.size();
        scene.find(10); // all nodes
        scene.contact(dt);
        const auto from_all = scene.bodies.force.to_host();
        all += scene.pairs.nodes.node.size();
        for (std::size_t b = 0; b < 2; ++b)
        {
            touching += from_all[b].norm() > 0;
            worst = std::max(worst, (from_list[b] - from_all[b]).norm() / std::max(from_all[b].norm(), 1.0));
        }
    }
    std::printf("%d bodies in contact; forces from %lld listed of %lld nodes differ by %.1e, tolerance 1e-12 (order of "
                "the sums)\n",
                touching, static_cast<long long>(listed), static_cast<long long>(all), worst);
    EXPECT_GT(touching, 100);
    EXPECT_LT(2 * listed, all);
    EXPECT_LT(worst, 1e-12);
}

TYPED_TEST(BodyContact, TwoRunsGiveTheSameBits)
{
    SolidNumbers numbers;
    numbers.friction = 0.4;
    numbers.zeta     = 0.1;
    std::vector<double> ends;
    for (int run = 0; run < 2; ++run)
    {
        typename TestFixture::Scene scene(this->exec(), {box_solid({0.08, 0.1, 0.12}, 10, 40)}, off_centre_boxes(),
                                          numbers);
        scene.run(1e-5, 5000);
        const auto position = scene.bodies.position.to_host();
        ends.insert(ends.end(), {position[0][0], position[0][1], position[1][2]});
    }
    EXPECT_EQ(std::vector<double>(ends.begin(), ends.begin() + 3), std::vector<double>(ends.begin() + 3, ends.end()));
}

TYPED_TEST(BodyContact, StiffnessIsExpectedBeforeItIsFelt)
{
    constexpr double            dt = 2e-5;
    const Vec3<double>          direction(1, 0, 0);
    typename TestFixture::Scene scene(this->exec(), {unit_sphere(2, 40)}, head_on(direction), {});
    EXPECT_EQ(smallest_contact_time(this->exec(), scene.pairs, scene.bodies.view()), 0);

    scene.find(10 * dt);
    expect_contacts(this->exec(), scene.pairs, scene.bodies.view(), scene.law(), Vec3<double>::Zero(), dt);
    // two nodes at d0 of the pair's half-weighted nodes: K = A E*/(pi sqrt(R* d0))
    const double effective = 1e7 / 0.91 / 2, area = 4 * std::numbers::pi * radius * radius / 162, knee = 1e-3 * 0.1;
    const double stiffness = area * effective / (std::numbers::pi * std::sqrt(0.1 * knee));
    const double mass      = scene.bodies.mass.to_host()[0];
    EXPECT_NEAR(smallest_contact_time(this->exec(), scene.pairs, scene.bodies.view()), std::sqrt(mass / stiffness),
                1e-9);

    scene.run(dt, 1000, 10); // 20 ms: past the deepest point, 22 of 200 mm
    expect_contacts(this->exec(), scene.pairs, scene.bodies.view(), scene.law(), Vec3<double>::Zero(), dt);
    const double live = scene.bodies.stiffness.to_host()[0];
    EXPECT_NEAR(smallest_contact_time(this->exec(), scene.pairs, scene.bodies.view()), std::sqrt(mass / live), 1e-9);
    const auto scaled = [&](std::int64_t named) {
        return smallest_contact_time(this->exec(), scene.pairs, scene.bodies.view(), {named, 9});
    };
    EXPECT_NEAR(scaled(0), 3 * std::sqrt(mass / live), 1e-9);
    EXPECT_NEAR(scaled(1), std::sqrt(mass / live), 1e-9) << "a named body keeps its inertia";
    const double ratio =
        read(this->exec(), largest_overlap(this->exec(), scene.pairs, scene.bodies.view(), scene.law()));
    EXPECT_GT(ratio, 0.08);
    EXPECT_LT(ratio, 0.12);
    EXPECT_EQ(deepest_pair(scene.pairs, ratio), dem::pair_key(0, 1));
}

} // namespace dem_contact_test
} // namespace tread::test
