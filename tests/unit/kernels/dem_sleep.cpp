#include <cstring>
#include <vector>

#include "dem_scene.hpp"
#include "kernels/dem/sleep/sleep.hpp"

// Bodies that fall asleep and wake: what they keep, and who is computed.
namespace tread::test
{
namespace dem_sleep_test
{

constexpr double radius = 0.1, dt = 1e-4, rest = 5e-3;
constexpr int    window = 51; ///< substeps, just over `rest`

/// Two columns of three balls on a floor, damped until they lie still; the second column stands apart.
template<class Exec>
class BodySleep : public DemTest<Exec>
{
protected:
    using Scene = SolidScene<Exec>;

    static Scene columns(const Exec& exec)
    {
        SolidNumbers numbers;
        numbers.friction = 0.5;
        numbers.zeta     = 0.4;
        numbers.gravity  = {0, 0, -9.8};
        numbers.planes   = {{{0, 0, 1}, 0.0, false}};
        std::vector<Solid> solids;
        for (int i = 0; i < 6; ++i)
        {
            const double x = i < 3 ? 0 : 1;
            solids.push_back(solid_sphere(radius, 2000, {x, 0, radius * (1 + 1.999 * (i % 3))}));
            solids.back().damped = 1;
        }
        return Scene(exec, {exact_sphere()}, solids, numbers);
    }

    /// Lets the columns come to rest, and asks once more after the time at rest.
    static dem::SleepCount come_to_rest(const Exec& exec, Scene& scene, double load)
    {
        dem::begin_sleep(exec, scene.pairs, scene.bodies, {1e-3, rest, load, 0});
        for (int step = 0; step < 200; ++step)
        {
            scene.find(100 * dt);
            for (int i = 0; i < 100; ++i)
            {
                evaluate_contacts(exec, scene.pairs, scene.bodies.view(), scene.law(), dt);
                scene.move(dt, 0.3);
            }
        }
        dem::look_at_sleep(exec, scene.pairs, scene.bodies.view(), scene.law());
        return pass(exec, scene);
    }

    /// Takes the substeps of a window, then looks.
    static dem::SleepCount pass(const Exec& exec, Scene& scene)
    {
        for (int i = 0; i < window; ++i)
        {
            evaluate_contacts(exec, scene.pairs, scene.bodies.view(), scene.law(), dt);
            scene.move(dt);
            scene.pairs.sleep.pass(dt);
        }
        return dem::look_at_sleep(exec, scene.pairs, scene.bodies.view(), scene.law());
    }

    static void fall_asleep(const Exec& exec, Scene& scene)
    {
        dem::fall_asleep(exec, scene.pairs, scene.bodies.view(), scene.law(), scene.totals.data(), dt,
                         scene.numbers.gravity);
        find(scene);
    }

    /// Lists pairs; who is marked, or near what moves, wakes.
    static void find(Scene& scene)
    {
        scene.pairs.sleep.wakes = true;
        scene.find(100 * dt);
        scene.pairs.sleep.wakes = false;
    }
};
TYPED_TEST_SUITE(BodySleep, Backends, BackendNames);

template<class T>
bool same_bits(const std::vector<T>& one, const std::vector<T>& other)
{
    return one.size() == other.size() &&
           std::memcmp(static_cast<const void*>(one.data()), static_cast<const void*>(other.data()),
                       one.size() * sizeof(T)) == 0;
}

TYPED_TEST(BodySleep, KeepsContactsAndComputesNothing)
{
    auto       scene = this->columns(this->exec());
    const auto found = this->come_to_rest(this->exec(), scene, 0.1);
    EXPECT_EQ(found.tired, 6);
    EXPECT_EQ(found.awake, 6);
    const std::vector<std::uint64_t> keys   = scene.pairs.key.to_host();
    const double                     energy = scene.sums().contact;
    this->fall_asleep(this->exec(), scene);
    EXPECT_EQ(scene.pairs.key.size(), 0);
    EXPECT_EQ(scene.pairs.sleep.moved.size(), 0);
    EXPECT_EQ(scene.pairs.sleep.count, 6);
    EXPECT_EQ(scene.pairs.sleep.pairs.key.to_host(), keys);
    const double kept = scene.sums().contact;
    std::printf("contact energy: measured %.9e, expected %.9e J, tolerance 1e-6 of it: at rest one substep changes "
                "less\n",
                kept, energy);
    EXPECT_NEAR(kept, energy, 1e-6 * energy);

    const auto place = scene.bodies.position.to_host();
    this->pass(this->exec(), scene);
    EXPECT_EQ(scene.bodies.position.to_host(), place);
    const auto before = scene.pairs.sleep.pairs.patch.to_host();
    dem::wake_all(scene.pairs, scene.bodies);
    this->find(scene);
    EXPECT_EQ(scene.pairs.key.to_host(), keys);
    EXPECT_TRUE(same_bits(scene.pairs.patch.to_host(), before));
    EXPECT_EQ(scene.pairs.sleep.moved.size(), 6);
    EXPECT_EQ(scene.pairs.sleep.count, 0);
    EXPECT_EQ(scene.pairs.sleep.pairs.key.size(), 0);
    EXPECT_EQ(scene.sums().contact, 0) << "no answers yet, and nothing asleep";
}

/// A body that trembles about a place rests, however fast it is; one that creeps out of it does not.
TYPED_TEST(BodySleep, WaysCountAndNotSpeeds)
{
    constexpr double limit = 1e-3 * rest;
    auto             scene = this->columns(this->exec());
    EXPECT_EQ(this->come_to_rest(this->exec(), scene, 0.1).tired, 6);
    const auto look_at = [&](double height)
    {
        auto position = scene.bodies.position.to_host();
        position[5][2] += height;
        scene.bodies.position.assign(position);
        scene.pairs.sleep.pass(0.25 * rest);
        return dem::look_at_sleep(this->exec(), scene.pairs, scene.bodies.view(), scene.law());
    };
    for (int i = 0; i < 8; ++i) { EXPECT_EQ(look_at(i % 2 == 0 ? 0.9 * limit : -0.9 * limit).tired, 6) << i; }
    EXPECT_EQ(look_at(1.1 * limit).tired, 4) << "nor what it may touch";
    EXPECT_EQ(scene.pairs.sleep.moves.to_host()[5], 0) << "it had stayed for longer";
    look_at(1.1 * limit);
    EXPECT_EQ(scene.pairs.sleep.moves.to_host()[5], 1);
    for (int i = 0; i < 3; ++i) { EXPECT_EQ(look_at(0).tired, 4) << i; }
    EXPECT_EQ(look_at(0).tired, 6);
    EXPECT_EQ(scene.pairs.sleep.moves.to_host()[5], 0);
    look_at(2.1 * limit);
    EXPECT_EQ(scene.pairs.sleep.moves.to_host()[5], 1) << "it was hit";
}

/// A ball that comes near wakes the column that it may touch, and not the other.
TYPED_TEST(BodySleep, WakesWhatAMovingBodyComesNear)
{
    auto scene = this->columns(this->exec());
    this->come_to_rest(this->exec(), scene, 0.1);
    this->fall_asleep(this->exec(), scene);
    // The top ball of the second column is lifted, thrown at the first column, and awake.
    const auto set = [&](auto& array, std::size_t at, const auto& value)
    {
        auto values = array.to_host();
        values[at]  = value;
        array.assign(values);
    };
    set(scene.bodies.position, 5, Vec3<double>(0, 0, 7.01 * radius));
    set(scene.bodies.velocity, 5, Vec3<double>(0, 0, -1));
    set(scene.bodies.asleep, 5, 0);
    set(scene.pairs.sleep.moves, 5, 1);
    scene.pairs.sleep.change = true;
    this->find(scene);
    EXPECT_EQ(scene.bodies.asleep.to_host(), (std::vector<std::int32_t>{0, 0, 0, 1, 1, 0}))
        << "two contacts on from what is hit";
    EXPECT_EQ(scene.pairs.sleep.count, 2);
    EXPECT_EQ(scene.pairs.sleep.moved.to_host(), (std::vector<std::int32_t>{0, 1, 2, 5}));
    EXPECT_EQ(scene.pairs.sleep.pairs.key.size(), 2) << "floor and ball, ball and ball";
}

/// Sand that presses on a sleeping ball: below the limit it sleeps on, above it wakes with its neighbours.
TYPED_TEST(BodySleep, WakesWhereTheLoadChanges)
{
    constexpr double share = 0.1;
    auto             scene = this->columns(this->exec());
    this->come_to_rest(this->exec(), scene, share);
    this->fall_asleep(this->exec(), scene);
    const double                   weight = 9.8 * scene.bodies.mass.to_host()[5];
    Array<TypeParam, std::int32_t> run(this->exec(), "runs"), first(this->exec(), "parts");
    run.assign({-1, -1, -1, -1, -1, 0}); // on the top of the second column, which carries its own weight
    first.assign({0, 1});
    Array<TypeParam, dem::ContactWrench> part(this->exec(), "wrenches");
    const auto                           press = [&](double force)
    {
        part.assign({{Vec3<double>(0, 0, -force), Vec3<double>::Zero(), 0}});
        const dem::OutsideWrenches outside{run.data(), first.data(), part.data()};
        dem::list_moved_bodies(this->exec(), scene.pairs, scene.bodies.view(), outside);
        EXPECT_EQ(scene.pairs.sleep.moved.to_host(), std::vector<std::int32_t>{5});
        for (int i = 0; i < window; ++i)
        {
            scene.move(dt, 0, outside);
            scene.pairs.sleep.pass(dt);
        }
        return dem::look_at_sleep(this->exec(), scene.pairs, scene.bodies.view(), scene.law());
    };
    EXPECT_EQ(press(0).wake, 0);
    EXPECT_EQ(press(0).wake, 0); // the first whole window: the load of rest
    const double stopped = scene.sums().total.holding_impulse[2];
    EXPECT_EQ(press(0.9 * share * weight).wake, 0);
    EXPECT_EQ(press(1.1 * share * weight).wake, 1);
    const double held = scene.sums().total.holding_impulse[2] - stopped, pressed = 2 * share * weight * window * dt;
    std::printf("impulse that holds it: measured %.12e, expected %.12e N s, tolerance 1e-12 of it: a sum of %d terms\n",
                held, pressed, 2 * window);
    EXPECT_NEAR(held, pressed, 1e-12 * pressed);
    this->find(scene);
    EXPECT_EQ(scene.bodies.asleep.to_host(), (std::vector<std::int32_t>{1, 1, 1, 0, 0, 0}));
}

} // namespace dem_sleep_test
} // namespace tread::test
