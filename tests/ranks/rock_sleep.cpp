#include <algorithm>
#include <cstdio>
#include <cstring>
#include <map>

#include "physics/strewn_bed.hpp"
#include "side_by_side.hpp"

// Rocks that sleep on several ranks, compared with the same on one (docs/sleep.md#rocks-that-sleep).
namespace rock_sleep_ranks_test
{

using namespace tread;

const Vec3<double> size(1.2, 0.12, 1.2); ///< m

/// Two rows of spheres that roll to the wall on the right and lean against it, so that each presses its neighbours, and
/// a ball that falls on them when they sleep.
const std::string rows_text = R"(
title = "rows of spheres"
[domain]
size    = [1.2, 0.12, 1.2]
gravity = [10.0, 0.0, -20.0]
walls   = { x = "slip", y = "slip", bottom = "fixed", top = "open" }
[time]
dt       = 5e-4
substeps = 4
[sleep]
rock_speed = 0.05
rock_rest  = 0.02
[[material]]
name    = "stone"
model   = "elastic"
density = 2700.0
young   = 1e7
poisson = 0.25
[[contact]]
between          = ["stone", "stone"]
friction         = 0.5
restitution      = 0.1
rolling_friction = 0.1
[[contact]]
between          = ["stone", "wall"]
friction         = 0.5
restitution      = 0.1
rolling_friction = 0.1
[[shape]]
name      = "sphere"
generate  = { kind = "sphere", nodes = 42 }
sdf_cells = 20
[[rocks]]
shape     = "sphere"
material  = "stone"
count     = 28
diameter  = 0.05
placement = "grid"
region    = { box = [[0.1, 0.0, 0.0], [1.2, 0.12, 0.055]] }
[[body]]
name     = "ball"
shape    = "sphere"
material = "stone"
diameter = 0.1
mass     = 1.0
position = [0.3, 0.06, 1.1]
velocity = [-2.0, 0.0, 5.0]
[[phase]]
name     = "fall"
duration = 2.0
)";

constexpr std::int64_t rocks = 28;

/// Number of sleepers after each step of both runs, which must be the same.
struct Slept
{
    std::int64_t most  = 0;
    std::int64_t woken = 0; ///< sum over steps
    std::int64_t last  = 0;
    std::int64_t steps = 0;
};

/// Expects that all holders of a sleeper watch the same load, to the bit. Collective.
template<class Exec>
void compare_watches(solver::DemSolver<Exec>& rigid)
{
    struct Watched
    {
        double          number;
        dem::SleepWatch watch;
    };
    const std::vector<std::int32_t>    asleep = rigid.bodies().asleep.to_host(), role = rigid.bodies().role.to_host();
    const std::vector<dem::SleepWatch> watch = rigid.sleepers().watch.to_host();
    std::vector<Watched>               held;
    for (std::size_t row = 0; row < role.size(); ++row)
    {
        const auto number = static_cast<double>(rigid.numbers().number(static_cast<std::int64_t>(row)));
        if (role[row] != dem::role_none && asleep[row] != 0) { held.push_back({number, watch[row]}); }
    }
    std::map<double, dem::SleepWatch> of_first;
    for (const std::vector<Watched>& of_rank : decomp::gather_values(test::world(), held))
    {
        for (const Watched& one : of_rank)
        {
            const auto [first, is_first] = of_first.try_emplace(one.number, one.watch);
            const bool same              = std::memcmp(&first->second, &one.watch, sizeof(one.watch)) == 0;
            EXPECT_TRUE(is_first || same) << "watch over rock " << one.number;
        }
    }
}

/// Forces on all rocks (N), by number. Collective where the simulation is on several ranks.
template<class Exec>
std::map<std::int64_t, Vec3<double>> forces_of(solver::Simulation<Exec, double>& simulation)
{
    struct Loaded
    {
        std::int64_t number;
        Vec3<double> force;
    };
    solver::DemSolver<Exec>&        rigid = simulation.rigid();
    const auto                      force = rigid.bodies().force.to_host();
    const std::vector<std::int32_t> role  = rigid.bodies().role.to_host();
    std::vector<Loaded>             own;
    for (std::size_t row = 0; row < force.size(); ++row)
    {
        if (!role.empty() && role[row] != dem::role_owner) { continue; }
        own.push_back({rigid.numbers().number(static_cast<std::int64_t>(row)), force[row]});
    }
    std::map<std::int64_t, Vec3<double>> all;
    const auto                           of_ranks =
        role.empty() ? std::vector<std::vector<Loaded>>{own} : decomp::gather_values(test::world(), own);
    for (const std::vector<Loaded>& of_rank : of_ranks)
    {
        for (const Loaded& one : of_rank) { all[one.number] = one.force; }
    }
    return all;
}

template<class Exec>
class RocksAsleepOnRanks : public test::BackendTest<Exec>
{
protected:
    static int ranks() { return test::world().size(); }

    static void advance(test::SideBySide<Exec>& run, int steps, Slept& slept)
    {
        for (int step = 0; step < steps; ++step)
        {
            run.advance();
            const std::int64_t one = run.alone.simulation().rocks_asleep(),
                               all = run.together.simulation().rocks_asleep();
            ASSERT_EQ(one, all) << "step " << step;
            if (++slept.steps % 20 == 0) { test::compare_holders(run.together.simulation().rigid()); }
            slept.most = std::max(slept.most, one);
            slept.woken += std::max<std::int64_t>(slept.last - one, 0);
            slept.last = one;
        }
    }

    /// Places and motion agree to `bound` (m, m/s), balances of energy and momentum to `balance`; all holders of a rock
    /// have its state to the bit.
    static void expect_as_alone(test::SideBySide<Exec>& run, const Slept& slept, double bound, double balance)
    {
        const int ghosts = test::compare_holders(run.together.simulation().rigid());
        compare_watches(run.together.simulation().rigid());
        const auto forces = forces_of(run.alone.simulation()), forces_together = forces_of(run.together.simulation());
        double     force = 0, off = 0;
        for (const auto& [number, of_one] : forces)
        {
            force = std::max(force, of_one.norm());
            off   = std::max(off, (of_one - forces_together.at(number)).norm());
        }
        std::printf("forces up to %.4g N differ by %.3g N\n", force, off);
        EXPECT_LE(off, 100 * bound * force) << "contacts are stiff";
        const io::BodyFields one = run.alone.simulation().body_fields(), all = run.bodies_together();
        const double         places = test::difference(one.position, all.position, 1.0),
                     speeds         = test::difference(one.velocity, all.velocity, 1.0);
        std::printf("at most %d rocks slept, %d woke, %d sleep at the end; %d ghosts; places differ by %.3g m, "
                    "velocities by %.3g m/s, bound %.3g\n",
                    static_cast<int>(slept.most), static_cast<int>(slept.woken), static_cast<int>(slept.last), ghosts,
                    places, speeds, bound);
        EXPECT_LT(places, bound);
        EXPECT_LT(speeds, bound);
        const solver::Census of_one = run.alone.simulation().census(), of_all = run.together.simulation().census();
        const auto alone = test::errors_of(run.alone, of_one), together = test::errors_of(run.together, of_all);
        std::printf("energy unaccounted %.3g, alone %.3g; momentum %.3g, %.3g\n", together.energy, alone.energy,
                    together.momentum, alone.momentum);
        EXPECT_NEAR(alone.energy, together.energy, balance);
        EXPECT_NEAR(alone.momentum, together.momentum, balance);
        EXPECT_NEAR(run.alone.simulation().mean_rocks_asleep().value(),
                    run.together.simulation().mean_rocks_asleep().value(), 1e-12);
    }
};
TYPED_TEST_SUITE(RocksAsleepOnRanks, test::Backends, test::BackendNames);

/// Rocks press each other over the borders while they sleep, and wake where the ball falls. Bounds: rounding of sums in
/// another order, which the impact multiplies.
TYPED_TEST(RocksAsleepOnRanks, ABallFallsOnThem)
{
    test::SideBySide<TypeParam> run(this->exec(), test::load_text(rows_text), size,
                                    test::slabs(size[0], this->ranks()));
    Slept                       slept;
    this->advance(run, 1200, slept);
    if (::testing::Test::HasFailure()) { return; }
    this->expect_as_alone(run, slept, 1e-12, 1e-12);
    EXPECT_EQ(slept.last, rocks);
    this->advance(run, 300, slept);
    if (::testing::Test::HasFailure()) { return; }
    this->expect_as_alone(run, slept, 1e-8, 1e-9);
    EXPECT_LT(slept.last, rocks) << "the ball wakes some";
}

/// What sleeps goes to another rank with its page: asleep, with its load and its contacts.
TYPED_TEST(RocksAsleepOnRanks, SleepersChangeTheirOwner)
{
    test::SideBySide<TypeParam> run(this->exec(), test::load_text(rows_text), size,
                                    test::slabs(size[0], this->ranks()));
    Slept                       slept;
    this->advance(run, 1100, slept);
    if (::testing::Test::HasFailure()) { return; }
    run.give_pages(size, test::quarters({0.8, 0.06, 0}, this->ranks()));
    run.alone.simulation().rigid().forget_list(); // ranks list pairs anew, too
    this->advance(run, 100, slept);
    if (::testing::Test::HasFailure()) { return; }
    this->expect_as_alone(run, slept, 1e-12, 1e-12);
    EXPECT_EQ(slept.last, rocks);
    this->advance(run, 300, slept);
    if (::testing::Test::HasFailure()) { return; }
    this->expect_as_alone(run, slept, 1e-8, 1e-9);
    EXPECT_LT(slept.last, rocks) << "the ball wakes some";
}

/// Rocks asleep on sand that is computed, which crosses the border below them.
TYPED_TEST(RocksAsleepOnRanks, OnSand)
{
    const std::string text =
        std::string(test::sand_text) + "[numerics]\nprecision = \"double\"\n" + test::stone(1e7, 0.5, 0.5) +
        "[[shape]]\nname = \"pebble\"\ngenerate = { kind = \"sphere\", nodes = 42 }\nsdf_cells = 20\n"
        "[[rocks]]\nshape = \"pebble\"\nmaterial = \"stone\"\ncount = 4\ndiameter = 0.1\n"
        "placement = \"grid\"\nregion = { box = [[0.0, 0.0, 0.23], [0.4, 0.4, 0.35]] }\n" +
        test::phase("lie", 0, 1.0) + "[sleep]\nrock_speed = 0.05\nrock_rest = 0.02\n";
    const Vec3<double>          box(0.4, 0.4, 0.6);
    test::SideBySide<TypeParam> run(this->exec(), test::load_text(text), box, test::slabs(box[0], this->ranks()));
    Slept                       slept;
    this->advance(run, 400, slept);
    if (::testing::Test::HasFailure()) { return; }
    this->expect_as_alone(run, slept, 1e-8, 1e-8);
    EXPECT_GT(slept.most, 0);
}

/// A bed of sand and rocks that sleeps, and a ball that falls on it in the middle.
const Vec3<double> bed_size(2.4, 0.4, 1.6); ///< m
const std::string  bed_text =
    test::long_bed + R"(
[[shape]]
name      = "sphere"
generate  = { kind = "sphere", nodes = 42 }
sdf_cells = 20
[[body]]
name     = "ball"
shape    = "sphere"
material = "stone"
diameter = 0.1
mass     = 1.4
position = [1.2, 0.2, 1.5]
)" + test::phase("fall", 0, 2.0) +
    "[sleep]\ndistance = 0.1\nspeed = 0.05\nrest = 0.02\nrock_speed = 0.05\nrock_rest = 0.02\n";

template<class Exec>
class StrewnRanks : public RocksAsleepOnRanks<Exec>
{
protected:
    /// Advances both; the same number of points sleeps in each step.
    static void advance(test::SideBySide<Exec>& run, int steps, Slept& slept)
    {
        for (int step = 0; step < steps; ++step)
        {
            RocksAsleepOnRanks<Exec>::advance(run, 1, slept);
            const std::int64_t one = run.alone.simulation().sand().asleep(),
                               all = test::world().sum(run.together.simulation().sand().asleep());
            ASSERT_EQ(one, all) << "step " << step;
            if (::testing::Test::HasFailure()) { return; }
        }
    }

    /// Expects that all sleeps.
    static void expect_all_asleep(test::SideBySide<Exec>& run, const Slept& slept)
    {
        EXPECT_EQ(slept.last, 12);
        EXPECT_EQ(run.alone.simulation().sand().asleep(), run.alone.simulation().sand().count());
    }
};
TYPED_TEST_SUITE(StrewnRanks, test::Backends, test::BackendNames);

/// Rocks lie in sand on both sides of borders; the ball wakes both.
TYPED_TEST(StrewnRanks, ABallFallsOnTheBed)
{
    test::SideBySide<TypeParam> run(this->exec(), test::load_text(bed_text), bed_size,
                                    test::slabs(bed_size[0], this->ranks()));
    Slept                       slept;
    this->advance(run, 400, slept);
    if (::testing::Test::HasFailure()) { return; }
    this->expect_all_asleep(run, slept);
    this->advance(run, 400, slept);
    if (::testing::Test::HasFailure()) { return; }
    this->expect_as_alone(run, slept, 1e-8, 1e-8);
    EXPECT_GT(slept.woken, 2);
}

/// Sleeping sand, the rocks in it and their contacts go to other ranks together: what held a rock goes on to hold it.
TYPED_TEST(StrewnRanks, SleepersChangeTheirOwner)
{
    test::SideBySide<TypeParam> run(this->exec(), test::load_text(bed_text), bed_size,
                                    test::slabs(bed_size[0], this->ranks()));
    Slept                       slept;
    this->advance(run, 300, slept);
    if (::testing::Test::HasFailure()) { return; }
    this->expect_all_asleep(run, slept);
    run.alone.simulation().census();
    run.together.simulation().census();
    run.give_pages(bed_size, test::quarters({1.5, 0.2, 0}, this->ranks()));
    run.together.simulation().follow_owners();
    run.alone.simulation().rigid().forget_list(); // ranks list pairs anew, too
    this->advance(run, 100, slept);
    if (::testing::Test::HasFailure()) { return; }
    this->expect_all_asleep(run, slept);
    this->expect_as_alone(run, slept, 1e-12, 1e-12);

    std::int64_t fewest = slept.last;
    for (int step = 0; step < 400; ++step)
    {
        run.together.advance();
        fewest = std::min(fewest, run.together.simulation().rocks_asleep());
    }
    const auto errors = test::errors_of(run.together, run.together.simulation().census());
    EXPECT_LT(fewest, slept.last) << "the ball wakes some";
    test::report("energy unaccounted", errors.energy, 0, 1e-3, "as the sleep of sand on one rank");
    test::report("momentum error", errors.momentum, 0, 1e-6, "what holds sleepers is accounted for; fp64");
    EXPECT_LT(std::abs(errors.energy), 1e-3);
    EXPECT_LT(errors.momentum, 1e-6);
}

} // namespace rock_sleep_ranks_test
