#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "base/random.hpp"
#include "dem_bumpy.hpp"

// Impacts of non-spherical bodies: restitution, and a law that dissipates and generates no energy.
namespace tread::test
{
namespace dem_impacts_test
{

template<class Exec>
class Impact : public DemTest<Exec>
{
};
TYPED_TEST_SUITE(Impact, Backends, BackendNames);

template<class Exec>
class FullSizeImpact : public Impact<Exec>
{
};
TYPED_TEST_SUITE(FullSizeImpact, Backends, BackendNames);

Quat random_turn(Random& random)
{
    const auto part = [&] { return random.uniform(-1, 1); };
    return Quat(part(), part(), part(), part()).normalized();
}

const dem::Plane ground{{0, 0, 1}, 0.0, false};

/// Speed after over speed before of body 0, thrown at 1 m/s along -z.
template<class Scene>
double rebound(Scene& scene, double dt, int steps)
{
    const double before = scene.bodies.velocity.to_host()[0][2];
    scene.run(dt, steps);
    EXPECT_EQ(scene.sums().contact, 0) << "still in contact";
    return -scene.bodies.velocity.to_host()[0][2] / before;
}

TYPED_TEST(Impact, RestitutionHoldsForFlatFacesAndSpheres)
{
    constexpr double wanted = 0.5, radius = 0.1;
    const auto       expect = [&](const char* what, double found)
    {
        std::printf("restitution of %s %.3f, expected %.3f, tolerance 0.07 (docs/verification.md#restitution)\n", what,
                    found, wanted);
        EXPECT_NEAR(found, wanted, 0.07) << what;
    };
    SolidNumbers numbers;
    numbers.zeta   = damping_ratio(wanted);
    numbers.planes = {ground};
    Solid cube;
    cube.mass       = 2;
    cube.inertia    = Mat3<double>::Identity() * (2 * 0.01 / 6);
    cube.position   = {0, 0, 0.0501};
    cube.velocity   = {0, 0, -1};
    const auto flat = box_solid(Vec3<double>::Constant(0.05), 8, 40);
    {
        typename TestFixture::Scene scene(this->exec(), {flat}, {cube}, numbers);
        expect("a cube's face on a plane", rebound(scene, 2e-6, 8000));
    }
    {
        Solid under    = cube;
        under.velocity = Vec3<double>::Zero();
        under.position = {0.01, 0.02, -0.05};
        under.locked   = dem::lock_all;
        numbers.planes = {};
        // turned by an eighth about the normal: nodes of the two lattices do not coincide
        under.orientation = Quat(Eigen::AngleAxisd(0.4, Vec3<double>::UnitZ()));
        typename TestFixture::Scene scene(this->exec(), {flat}, {cube, under}, numbers);
        expect("a cube's face on a held cube's", rebound(scene, 2e-6, 8000));
    }
    numbers.planes = {ground};
    for (const int level : {2, 4})
    {
        Solid ball       = solid_sphere(radius, 2500, {0, 0, 1.001 * radius});
        ball.orientation = Quat(Eigen::AngleAxisd(0.7, Vec3<double>(1, 2, 3).normalized()));
        ball.velocity    = {0, 0, -1};
        typename TestFixture::Scene scene(this->exec(), {unit_sphere(level, 64)}, {ball}, numbers);
        expect(level == 2 ? "a sphere of 162 nodes on a plane" : "a sphere of 2562 nodes on a plane",
               rebound(scene, 1e-5, 4000));
    }
}

/// Two equal bumpy bodies of 0.1 m in the frame of their centre of mass, 1 m/s, centres off by a quarter of a radius.
std::vector<Solid> off_centre(const BumpyBody& body, Random& random)
{
    Solid first        = body.solid(0.1, 2500);
    first.orientation  = random_turn(random);
    first.position     = {0.12, 0.0125, 0.005};
    first.velocity     = {-0.5, 0, 0};
    Solid second       = body.solid(0.1, 2500);
    second.orientation = random_turn(random);
    second.position    = -first.position;
    second.velocity    = -first.velocity;
    return {first, second};
}

struct Blow
{
    double energy = 0; ///< relative change
    double force  = 0; ///< N, the largest
};

template<class Scene>
Blow strike(Scene& scene)
{
    constexpr double dt    = 4e-6; // a 5000th of the contact duration: the step's own error is below 1e-6
    constexpr int    block = 25, blocks = 900;
    const double     before  = scene.sums().kinetic;
    bool             touched = false;
    Blow             blow;
    for (int i = 0; i < blocks; ++i)
    {
        scene.run(dt, block, block);
        const double force = scene.bodies.force.to_host()[0].norm();
        blow.force         = std::max(blow.force, force);
        touched            = touched || force > 0;
        if (touched && force == 0 && scene.bodies.velocity.to_host()[0][0] > 0) { break; }
    }
    blow.energy = (scene.sums().kinetic + scene.sums().contact) / before - 1;
    return blow;
}

TYPED_TEST(FullSizeImpact, BumpyBodiesKeepTheirEnergyInAnyOrientation)
{
    constexpr int         turns = 12;
    const BumpyBody       body(64);
    std::array<double, 3> force{};
    const std::array      nodes{162, 642, 2562};
    for (std::size_t level = 0; level < nodes.size(); ++level)
    {
        const SolidShape shape = body.shape(nodes[level]);
        Random           random(5);
        double           worst = 0, squares = 0;
        for (int turn = 0; turn < turns; ++turn)
        {
            typename TestFixture::Scene scene(this->exec(), {shape}, off_centre(body, random), {});
            const Blow                  blow = strike(scene);
            EXPECT_GT(blow.force, 10) << "they missed each other";
            force[level] += blow.force / turns;
            worst = std::max(worst, std::abs(blow.energy));
            squares += blow.energy * blow.energy / turns;
        }
        std::printf("%d nodes: change of energy %.1e rms, %.1e at most; limit 2e-5 at 642 nodes; mean F_max "
                    "%.2f N\n",
                    nodes[level], std::sqrt(squares), worst, force[level]);
        if (nodes[level] == 642) { EXPECT_LT(worst, 2e-5); }
    }
    const double coarse = std::abs(force[1] - force[0]), fine = std::abs(force[2] - force[1]);
    std::printf("F_max changes by %.2f N, then by %.2f N: expected to converge (a lattice of nodes is of second order: "
                "by a quarter; demanded: by half)\n",
                coarse, fine);
    EXPECT_LT(fine, 0.5 * coarse);
    EXPECT_LT(fine, 0.01 * force[2]);
}

/// Positions of body 0 about fixed body 1: time 0 to 1 is once around a closed path, in and out of contact.
Solid on_loop(const BumpyBody& body, double time)
{
    const double angle = 2 * std::numbers::pi * time;
    Solid        solid = body.solid(0.1, 2500);
    solid.position     = {0.198 + 0.006 * std::cos(angle), 0.03 * std::sin(angle), 0.02 * std::sin(2 * angle)};
    solid.orientation  = Quat(Eigen::AngleAxisd(0.2 * std::sin(angle), Vec3<double>(1, 1, 2).normalized())) *
                        Quat(Eigen::AngleAxisd(0.1 * std::cos(angle), Vec3<double>(0, 1, -1).normalized()));
    return solid;
}

TYPED_TEST(Impact, WorkOfAClosedLoopIsNothing)
{
    const BumpyBody             body(64);
    Solid                       held = body.solid(0.1, 2500);
    typename TestFixture::Scene scene(this->exec(), {body.shape(642)}, {on_loop(body, 0), held}, {});
    constexpr int               steps = 4000;
    double                      work = 0, largest = 0, passed = 0;
    Vec3<double>                force = Vec3<double>::Zero(), torque = force, place = on_loop(body, 0).position;
    Quat                        turn = on_loop(body, 0).orientation;
    for (int i = 0; i <= steps; ++i)
    {
        const Solid now = on_loop(body, static_cast<double>(i) / steps);
        scene.bodies.position.assign({now.position, held.position});
        scene.bodies.orientation.assign({now.orientation, held.orientation});
        if (i % 20 == 0) { scene.find(0.01); }
        scene.contact(1e-6);
        const Vec3<double>      new_force  = read(this->exec(), scene.bodies.force.data());
        const Vec3<double>      new_torque = read(this->exec(), scene.bodies.torque.data());
        const Eigen::AngleAxisd turned(now.orientation * turn.conjugate());
        const double            step = 0.5 * (force + new_force).dot(now.position - place) +
                            0.5 * (torque + new_torque).dot(turned.angle() * turned.axis());
        if (i > 0)
        {
            work += step;
            passed += std::abs(step);
        }
        force = new_force, torque = new_torque, place = now.position, turn = now.orientation;
        largest = std::max(largest, scene.sums().contact);
    }
    std::printf("work of a closed loop %.1e J; contact energy up to %.3f J, work that changed hands %.3f J; tolerance "
                "1e-3 of the energy (issue; what is left is the sum over %d places)\n",
                work, largest, passed, steps);
    EXPECT_GT(largest, 0.01);
    EXPECT_GT(passed, largest);
    EXPECT_LT(std::abs(work), 1e-3 * largest);
}

} // namespace dem_impacts_test
} // namespace tread::test
