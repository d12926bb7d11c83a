#include <algorithm>
#include <cstdio>

#include "side_by_side.hpp"

// Sand that sleeps on several ranks, compared with the same on one.
namespace sleep_ranks_test
{

using namespace tread;

const Vec3<double> size(3.2, 0.2, 0.8); ///< m

/// A trench of sand with geostatic stress, in pages of 0.2 m, and a roller that is driven through it from the left.
const std::string trench_text = R"(
title = "trench"
[domain]
size    = [3.2, 0.2, 0.8]
gravity = [0.0, 0.0, -9.81]
[grid]
spacing = 0.05
[numerics]
precision = "double"
[sleep]
distance = 0.3
rest     = 0.05
[[material]]
name               = "sand"
model              = "mohr-coulomb"
density            = 1600.0
young              = 1.0e6
poisson            = 0.3
friction_angle_deg = 30.0
[[terrain]]
material = "sand"
region   = { box = [[0.0, 0.0, 0.0], [3.2, 0.2, 0.2]] }
[[material]]
name    = "steel"
model   = "elastic"
density = 7800.0
young   = 1.0e9
poisson = 0.3
[[shape]]
name      = "roller"
generate  = { kind = "wheel", radius = 0.1, width = 0.1, wall_thickness = 0.04, grousers = 0 }
sdf_cells = 32
[[body]]
name     = "roller"
shape    = "roller"
material = "steel"
mass     = 5.0
position = [0.4, 0.1, 0.31]
velocity = [1.5, 0.0, -0.3]
lock     = ["y", "roll", "pitch", "yaw"]
[[phase]]
name     = "roll"
duration = 1.0
)";

template<class Exec>
class SleepRanks : public test::BackendTest<Exec>
{
protected:
    static int ranks() { return test::world().size(); }

    /// Sleeping points of all ranks.
    static std::int64_t asleep(test::Experiment<Exec>& experiment)
    {
        const std::int64_t own = experiment.simulation().sand().asleep();
        return experiment.simulation().balance() ? test::world().sum(own) : own;
    }

    /// Largest difference of the bodies' places (m) after steps in which as many points sleep, at times some.
    static double run_both(test::SideBySide<Exec>& run, int steps)
    {
        std::int64_t most = 0, woken = 0, last = 0;
        for (int step = 0; step < steps; ++step)
        {
            run.advance();
            const std::int64_t one = asleep(run.alone), all = asleep(run.together);
            EXPECT_EQ(one, all) << "step " << step;
            most = std::max(most, one);
            woken += std::max<std::int64_t>(last - one, 0);
            last = one;
            if (::testing::Test::HasFailure()) { return 0; }
        }
        const std::int64_t points = run.alone.simulation().sand().count();
        std::printf("%d of %d points slept at most, %d woke\n", static_cast<int>(most), static_cast<int>(points),
                    static_cast<int>(woken));
        EXPECT_GT(most, points / 3);
        EXPECT_GT(woken, 0);
        return test::difference(run.alone.simulation().body_fields().position, run.bodies_together().position, 1.0);
    }

    /// Mass, energy and momentum agree.
    static void expect_same_balances(test::SideBySide<Exec>& run, double bound)
    {
        const solver::Census one = run.alone.simulation().census(), all = run.together.simulation().census();
        EXPECT_NEAR(one.sand.mass, all.sand.mass, 1e-13 * one.sand.mass) << "a sum in another order";
        const double energy = one.sand.strain + one.rigid.kinetic;
        std::printf("strain energy %.6g J, alone %.6g J\n", all.sand.strain, one.sand.strain);
        EXPECT_NEAR(one.sand.strain, all.sand.strain, bound * energy);
        EXPECT_NEAR(one.sand.kinetic, all.sand.kinetic, bound * energy);
        const auto of_one = test::errors_of(run.alone, one), of_all = test::errors_of(run.together, all);
        EXPECT_NEAR(of_one.energy, of_all.energy, bound);
        EXPECT_NEAR(of_one.momentum, of_all.momentum, bound);
        const double slept = run.alone.simulation().mean_asleep().value();
        EXPECT_NEAR(slept, run.together.simulation().mean_asleep().value(), 1e-12);
    }
};
TYPED_TEST_SUITE(SleepRanks, test::Backends, test::BackendNames);

template<class Exec>
class FullSizeSleepRanks : public SleepRanks<Exec>
{
};
TYPED_TEST_SUITE(FullSizeSleepRanks, test::Backends, test::BackendNames);

/// Pages fall asleep and wake on both sides of borders, as the roller passes over them. Rounding of sums in another
/// order, over 300 steps without collisions, as in tests/ranks/coupled.cpp.
TYPED_TEST(FullSizeSleepRanks, AsOnOneRank)
{
    test::SideBySide<TypeParam> run(this->exec(), test::load_text(trench_text), size,
                                    test::slabs(size[0], this->ranks()));
    const double                places = this->run_both(run, 300);
    std::printf("places differ by %.3g m\n", places);
    EXPECT_LT(places, 1e-9);
    this->expect_same_balances(run, 1e-9);
}

/// The rank with the roller has all that is awake, and hands pages over; sleeping points go with their pages. Loads of
/// held pages begin anew on another rank, so that a page may wake sooner or later than on one.
TYPED_TEST(SleepRanks, PagesChangeTheirOwner)
{
    test::SideBySide<TypeParam> run(this->exec(), test::load_text(trench_text), size,
                                    test::slabs(size[0], this->ranks()), test::Owners::change);
    std::int64_t                most = 0;
    for (int step = 0; step < 400; ++step)
    {
        run.together.advance();
        most = std::max(most, this->asleep(run.together));
    }
    const std::int64_t        points = run.alone.simulation().sand().count();
    const decomp::BalanceRow& found  = *run.together.simulation().balance();
    std::printf("imbalance %.3f after %d repartitions, %d points moved; %d of %d points slept at most\n",
                found.imbalance, static_cast<int>(found.repartitions), static_cast<int>(found.points_moved),
                static_cast<int>(most), static_cast<int>(points));
    EXPECT_EQ(test::world().sum(run.together.simulation().sand().count()), points);
    EXPECT_GT(most, points / 3);
    EXPECT_GE(found.repartitions, this->ranks() > 1 ? 1 : 0);
    const solver::Census now    = run.together.simulation().census();
    const auto           errors = test::errors_of(run.together, now);
    test::report("energy unaccounted", errors.energy, 0, 1e-3, "as the sleep of sand on one rank");
    test::report("momentum error", errors.momentum, 0, 1e-6, "what holds sleeping sand is accounted for; fp64");
    EXPECT_LT(std::abs(errors.energy), 1e-3);
    EXPECT_LT(errors.momentum, 1e-6);
}

} // namespace sleep_ranks_test
