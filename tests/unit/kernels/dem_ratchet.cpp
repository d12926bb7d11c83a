#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "base/random.hpp"
#include "dem_scene.hpp"

// The history of a patch must neither generate energy in cycles nor lag behind bodies that rotate together
// (docs/verification.md#closed-cycles-of-friction).
namespace tread::test
{
namespace
{

template<class Exec>
class Ratchet : public DemTest<Exec>
{
};
TYPED_TEST_SUITE(Ratchet, Backends, BackendNames);

/// A closed cycle of load, shear and twist: each the sum of two harmonics of random amplitude and phase.
struct Cycle
{
    double size[2], phase[2];

    static Cycle draw(Random& random)
    {
        return {{random.uniform(0.1, 1), random.uniform(0, 0.5)},
                {random.uniform(0, 2 * std::numbers::pi), random.uniform(0, 2 * std::numbers::pi)}};
    }

    double at(double time) const
    {
        const double angle = 2 * std::numbers::pi * time;
        return size[0] * std::sin(angle + phase[0]) + size[1] * std::sin(2 * angle + phase[1]);
    }
};

/// Ten thousand random cycles, some within Coulomb's cap and some beyond: the energy dissipated by friction equals the
/// work put in, and no cycle returns more than that.
TEST(PatchCycles, TenThousandMakeNoEnergy)
{
    constexpr int      cycles = 10000, steps = 64;
    const dem::PairLaw law   = dem::pair_law({1e7, 8e6, 0.5, 0.0}, {1.0, 1e-3}, 10.0, 1.0);
    dem::Patch         patch = dem::no_patch();
    const Vec3<double> up    = Vec3<double>::UnitZ();
    Random             random(17);
    double             put_in = 0, lost = 0, largest = 0, least = 0;
    for (int c = 0; c < cycles; ++c)
    {
        const Cycle load = Cycle::draw(random), x = Cycle::draw(random), y = Cycle::draw(random),
                    twist        = Cycle::draw(random);
        const double held_before = dem::held_energy(law, patch), in_before = put_in;
        double       held = held_before;
        for (int i = 0; i < steps; ++i)
        {
            const double          from = static_cast<double>(i) / steps, to = static_cast<double>(i + 1) / steps;
            const double          level = 1 + 0.6 * load.at(to); // at least 0.1
            const Vec3<double>    moved(1e-4 * (x.at(to) - x.at(from)), 1e-4 * (y.at(to) - y.at(from)), 0);
            const double          turned = 5e-3 * (twist.at(to) - twist.at(from));
            const dem::Patch      before = patch;
            const dem::PatchState state{up, 1.0 * level, 2000 * level, 1e-4 * level, moved, turned, 0.0};
            const dem::Friction   friction = dem::update_patch(law, state, patch, 1.0);
            // the spring's force changes linearly from its old value, scaled to the new stiffness, to its new value
            const double shrunk = std::min(1.0, state.stiffness / std::max(before.stiffness, 1e-300));
            const double slack  = std::min(1.0, patch.twist_stiffness / std::max(before.twist_stiffness, 1e-300));
            put_in -= 0.5 * (shrunk * before.tangential + patch.tangential).dot(moved) +
                      0.5 * (slack * before.torsion + patch.torsion) * turned;
            EXPECT_GE(friction.lost, -1e-18);
            lost += friction.lost;
            held = friction.energy;
        }
        largest = std::max(largest, held);
        least   = std::min(least, put_in - in_before + held_before - held);
    }
    const double balance = (put_in - lost - dem::held_energy(law, patch)) / put_in;
    std::printf("put in %.6f J, lost %.6f J over %d cycles, balance %.1e of it (tolerance 0.02: a capped step's force "
                "turns within it); worst cycle %.1e J, springs held up to %.1e J\n",
                put_in, lost, cycles, balance, least, largest);
    EXPECT_GT(put_in, 0);
    EXPECT_GT(least, -1e-6 * largest);
    EXPECT_LT(std::abs(balance), 0.02);
}

/// Two spheres, pressed together and sheared, then rotated as one about an axis oblique to both contact and shear at 10
/// rad/s: the force between them rotates along, and keeps its magnitude.
TYPED_TEST(Ratchet, FrictionTurnsWithTwoBodiesThatTurnTogether)
{
    constexpr double radius = 0.1, dt = 1e-4, rate = 10;
    constexpr int    steps = 2000;
    SolidNumbers     numbers;
    numbers.friction        = 10;
    const Vec3<double> axis = Vec3<double>(1, 2, -1.5).normalized();
    // rotated so that no node is on a face between cells of the distance field, where the gradient jumps
    const Quat         start(Eigen::AngleAxisd(0.7, Vec3<double>(3, 1, 2).normalized()));
    std::vector<Solid> solids{solid_sphere(radius, 2500, {0, 0, 0.199}), solid_sphere(radius, 2500, {0, 0, 0})};
    for (Solid& solid : solids) { solid.orientation = start; }
    typename TestFixture::Scene scene(this->exec(), {unit_sphere(3, 64)}, solids, numbers);
    scene.find(0.01);
    scene.contact(dt);
    const Vec3<double> normal_force = scene.bodies.force.to_host()[0];
    scene.bodies.velocity.assign({{0.05, 0, 0}, {0, 0, 0}});
    for (int i = 0; i < 10; ++i) { scene.contact(dt); }
    scene.bodies.velocity.assign({Vec3<double>::Zero(), Vec3<double>::Zero()});
    scene.contact(dt);
    const Vec3<double> total = scene.bodies.force.to_host()[0], shear = total - normal_force;
    ASSERT_GT(shear.norm(), 0.01 * normal_force.norm());

    double longest = 0, askew = 0;
    for (int i = 1; i <= steps; ++i)
    {
        const Quat                turn(Eigen::AngleAxisd(rate * dt * i, axis));
        std::vector<Vec3<double>> position, velocity;
        for (const Solid& solid : solids)
        {
            position.push_back(turn * solid.position);
            velocity.push_back(rate * axis.cross(position.back()));
        }
        scene.bodies.position.assign(position);
        scene.bodies.velocity.assign(velocity);
        scene.bodies.orientation.assign({turn * start, turn * start});
        scene.bodies.angular_velocity.assign({rate * axis, rate * axis});
        if (i % 100 == 0) { scene.find(0.01); }
        scene.contact(dt);
        const Vec3<double> now = turn.conjugate() * scene.bodies.force.to_host()[0] - normal_force;
        longest                = std::max(longest, std::abs(now.norm() / shear.norm() - 1));
        askew                  = std::max(askew, std::acos(std::min(1.0, now.dot(shear) / now.norm() / shear.norm())));
    }
    // rotated by the smallest rotation of the normal, then about it: the two do not commute, (omega dt)^2/2 per step
    const double lag = 0.5 * rate * rate * dt * dt * steps;
    std::printf("length of the friction force changes by %.1e, tolerance 1e-6 "
                "(docs/verification.md#closed-cycles-of-friction); it lags by %.1e rad, tolerance "
                "%.1e (order of turns in a step)\n",
                longest, askew, lag);
    EXPECT_LT(longest, 1e-6);
    EXPECT_LT(askew, lag);
}

} // namespace
} // namespace tread::test
