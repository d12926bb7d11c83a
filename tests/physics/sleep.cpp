#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "harness.hpp"

// Sand that may sleep, compared with the same sand that may not.
namespace sleep_test
{

using namespace tread;

constexpr double spacing = 0.05; ///< m
constexpr double length  = 3.2;  ///< m

/// A box of a height (m) for sand in cells of 5 cm, and the sand.
std::string sand_text(double height)
{
    return fmt::format(R"(
title = "sand that may sleep"
[domain]
size    = [3.2, 0.4, {}]
gravity = [0.0, 0.0, -9.81]
[grid]
spacing = 0.05
[numerics]
precision = "double"
[[material]]
name               = "sand"
model              = "mohr-coulomb"
density            = 1600.0
young              = 1.0e6
poisson            = 0.3
friction_angle_deg = 30.0
)",
                       height);
}

/// A trench of sand, 3.2 x 0.4 x 0.2 m, with geostatic stress.
const std::string trench_text = sand_text(0.8) + R"(
[[terrain]]
material = "sand"
region   = { box = [[0.0, 0.0, 0.0], [3.2, 0.4, 0.2]] }
)";

const std::string sleep_text = R"(
[sleep]
distance = 0.4
)";

/// A roller that falls 6 cm and then drives.
const std::string roller_text = test::soft_steel_text + R"(
[[shape]]
name      = "roller"
generate  = { kind = "wheel", radius = 0.1, width = 0.2, wall_thickness = 0.04, grousers = 6 }
sdf_cells = 48
[[body]]
name     = "roller"
shape    = "roller"
material = "steel"
mass     = 10.0
position = [0.4, 0.2, 0.36]
lock     = ["roll", "yaw"]
[[phase]]
name     = "drop"
duration = 0.25
[[phase]]
name     = "drive"
duration = 0.35
drive    = { body = "roller", angular_velocity = 10.0, ramp = 0.1, slip = 0.2 }
)";

/// A column, 0.4 m high, that stands on the trench's left end and collapses over it.
const std::string column_text = R"(
[[terrain]]
material = "sand"
region   = { box = [[0.0, 0.0, 0.2], [0.3, 0.4, 0.6]] }
[[phase]]
name     = "collapse"
duration = 0.5
)";

/// A slope of 27 degrees, and a wheel at its foot that digs itself in, so that the slope comes down.
const std::string undercut_text = sand_text(1.0) + test::soft_steel_text + R"(
[[terrain]]
material = "sand"
region   = { box = [[0.0, 0.0, 0.0], [3.2, 0.4, 0.6]] }
height   = '0.2 + max(0, min(0.4, 0.5 * (1.6 - x)))'
[[contact]]
between  = ["steel", "sand"]
friction = 0.6
[[shape]]
name      = "roller"
generate  = { kind = "wheel", radius = 0.1, width = 0.3, wall_thickness = 0.04, grousers = 6 }
sdf_cells = 48
[[body]]
name     = "roller"
shape    = "roller"
material = "steel"
mass     = 30.0
position = [1.7, 0.2, 0.36]
lock     = ["x", "y", "roll", "yaw"]
[[phase]]
name     = "settle"
damping  = 0.3
duration = 0.3
hold     = ["roller"]
[[phase]]
name     = "rest"
duration = 0.3
hold     = ["roller"]
[[phase]]
name     = "dig"
duration = 0.8
drive    = { body = "roller", angular_velocity = 25.0, ramp = 0.1 }
)";

/// Result of a run.
struct Outcome
{
    std::vector<double> row; ///< values to compare
    double              steps    = 0;
    double              sleeper  = 0; ///< mean share of sleeping points
    double              most     = 0; ///< largest
    double              energy   = 0; ///< unaccounted, over the largest exchange
    double              momentum = 0;
    double              mass     = 0;
};

template<class Exec>
class Sleep : public test::BackendTest<Exec>
{
protected:
    /// Calls `watch(experiment)` after every step.
    template<class Watch>
    Outcome run(const std::string& text, Watch watch)
    {
        test::Experiment<Exec> experiment(this->exec(), text);
        auto&                  simulation = experiment.simulation();
        Outcome                outcome;
        const auto             look = [&](double)
        {
            outcome.steps += 1;
            const double asleep = static_cast<double>(simulation.sand().count() - simulation.sand().view().count) /
                                  static_cast<double>(simulation.sand().count());
            outcome.sleeper += asleep;
            outcome.most = std::max(outcome.most, asleep);
            watch(experiment);
        };
        experiment.run(look);
        outcome.sleeper /= outcome.steps;
        const solver::Census now = simulation.census();
        simulation.ledger().energy(now);
        simulation.ledger().balance(now);
        outcome.energy   = std::abs(simulation.ledger().errors().energy);
        outcome.momentum = simulation.ledger().errors().momentum;
        outcome.mass     = simulation.ledger().errors().mass;
        return outcome;
    }

    Outcome run(const std::string& text)
    {
        return run(text, [](auto&) {});
    }

    /// Distances along x of sleeping points from the first body, m.
    static std::vector<double> offsets_of_sleepers(test::Experiment<Exec>& experiment)
    {
        auto&               sand = experiment.simulation().sand();
        const double        at   = experiment.simulation().named_bodies().front().position[0];
        const auto          x    = sand.positions(); // sleeping points come last
        std::vector<double> offsets;
        for (auto i = static_cast<std::size_t>(sand.view().count); i < x.size(); ++i)
        {
            offsets.push_back(std::abs(x[i][0] - at));
        }
        return offsets;
    }

    /// Height of the sand in columns of two cells along x, m.
    static std::vector<double> profile(test::Experiment<Exec>& experiment)
    {
        std::vector<double> top(static_cast<std::size_t>(length / (2 * spacing)), 0.0);
        for (const Vec3<double>& x : experiment.simulation().sand().positions())
        {
            const auto column = static_cast<std::size_t>(std::clamp(x[0], 0.0, length - 1e-6) / (2 * spacing));
            top[column]       = std::max(top[column], x[2]);
        }
        return top;
    }

    /// The energy balance closes as well as without sleep.
    static void expect_balanced(const std::string& what, const Outcome& outcome, const Outcome& awake)
    {
        test::report(what + ": energy unaccounted", outcome.energy, awake.energy, 1e-3,
                     "what falls asleep gives its motion up, and the ledger accounts for it; without sleep as said");
        test::report(what + ": momentum error", outcome.momentum, awake.momentum, 1e-6,
                     "what holds the sleeping sand is accounted for as a wall's impulse; fp64");
        EXPECT_LT(outcome.energy, std::max(1e-3, 2 * awake.energy));
        EXPECT_LT(outcome.momentum, std::max(1e-6, 2 * awake.momentum));
        EXPECT_LT(outcome.mass, 1e-12);
    }
};
TYPED_TEST_SUITE(Sleep, test::Backends, test::BackendNames);

/// What takes half a minute.
template<class Exec>
class FullSizeSleep : public Sleep<Exec>
{
};
TYPED_TEST_SUITE(FullSizeSleep, test::Backends, test::BackendNames);

/// Only sand at rest: all of it falls asleep at the first check, and nothing is left to compute.
TYPED_TEST(Sleep, ABedAtRestSleepsAltogether)
{
    const std::string text    = trench_text + "[[phase]]\nname = \"rest\"\nduration = 0.3\n";
    const Outcome     outcome = this->run(text + sleep_text), awake = this->run(text);
    std::cout << "asleep at most " << outcome.most << ", on the mean " << outcome.sleeper << "\n";
    EXPECT_EQ(outcome.most, 1);
    EXPECT_EQ(awake.most, 0);
    this->expect_balanced("bed at rest", outcome, awake);
}

/// The roller drives 0.2 m, in a trench of which it disturbs a fifth. Sleeping sand always keeps its minimum distance
/// from it, and wakes as it approaches.
TYPED_TEST(FullSizeSleep, ARollerFarAwayFeelsNothing)
{
    constexpr double    reach = 0.1 + 0.4; // radius and distance
    std::vector<double> heights, awake_heights;
    double              nearest = length;
    std::int64_t        before = 0, woken = 0;
    const auto height_of  = [](auto& experiment) { return experiment.simulation().named_bodies().front().position[2]; };
    const Outcome outcome = this->run(trench_text + roller_text + sleep_text,
                                      [&](auto& experiment)
                                      {
                                          heights.push_back(height_of(experiment));
                                          if (heights.size() % 20 != 0) { return; }
                                          auto&              sand   = experiment.simulation().sand();
                                          const std::int64_t asleep = sand.count() - sand.view().count;
                                          woken += std::max<std::int64_t>(before - asleep, 0);
                                          before = asleep;
                                          for (const double off : this->offsets_of_sleepers(experiment))
                                          {
                                              nearest = std::min(nearest, off);
                                          }
                                      });
    const Outcome awake =
        this->run(trench_text + roller_text, [&](auto& experiment) { awake_heights.push_back(height_of(experiment)); });
    const auto mean = [](const std::vector<double>& all)
    {
        return std::accumulate(all.begin() + static_cast<long>(all.size() / 2), all.end(), 0.0) /
               static_cast<double>(all.size() - all.size() / 2);
    };
    const double sinkage = 0.3 - mean(awake_heights), other = 0.3 - mean(heights);
    std::cout << "asleep at most " << outcome.most << ", on the mean " << outcome.sleeper << "\n";
    constexpr double tolerance = 0.02;
    test::report("mean sinkage (m)", other, sinkage, tolerance * sinkage,
                 "a drive of 0.2 m in coarse sand differs as much by chance; docs/sleep.md has means over metres");
    test::report("nearest sleeping point, along x (m)", nearest, reach, 0.05,
                 "at least the roller's radius and 0.4 m, less 0.8 m/s times a look's 0.05 s");
    EXPECT_GT(outcome.most, 0.5);
    EXPECT_NEAR(other, sinkage, tolerance * sinkage);
    EXPECT_GT(nearest, reach - 0.05);
    EXPECT_GT(woken, 0);
    this->expect_balanced("roller", outcome, awake);
}

/// A column collapses over a sleeping bed: it wakes the sand that it reaches, and the deposit is the same as without
/// sleep.
TYPED_TEST(FullSizeSleep, ACollapseBesideSleepingPagesGoesItsWay)
{
    std::vector<double> tops, awake_tops;
    const Outcome       outcome =
        this->run(trench_text + column_text + sleep_text, [&](auto& e) { tops = this->profile(e); });
    const Outcome awake = this->run(trench_text + column_text, [&](auto& e) { awake_tops = this->profile(e); });
    std::cout << "asleep at most " << outcome.most << ", on the mean " << outcome.sleeper << "\n";
    double furthest = 0;
    for (std::size_t i = 0; i < tops.size(); ++i) { furthest = std::max(furthest, std::abs(tops[i] - awake_tops[i])); }
    test::report("largest difference of the profile (m)", furthest, 0, 0.5 * spacing,
                 "half a cell; single grains on a slope that has stopped lie where chance has put them");
    EXPECT_GT(outcome.most, 0.3);
    EXPECT_LT(furthest, 0.5 * spacing);
    this->expect_balanced("collapse", outcome, awake);
}

/// A wheel undercuts a slope that sleeps: it comes down as an awake one does. Half of the sand slept; an awake slope
/// beside a wheel that stands a micrometre further on differs by 0.03 mm, so that chance has no part in this.
TYPED_TEST(FullSizeSleep, AWheelUndercutsASlope)
{
    std::vector<double> start, tops, awake_tops;
    double              before = 0;
    const auto          share  = [](auto& experiment)
    {
        auto& sand = experiment.simulation().sand();
        return static_cast<double>(sand.count() - sand.view().count) / static_cast<double>(sand.count());
    };
    const Outcome outcome =
        this->run(undercut_text + "[sleep]\ndistance = 0.2\n",
                  [&](auto& experiment)
                  {
                      tops = this->profile(experiment);
                      if (experiment.simulation().named_bodies().front().angular_velocity.norm() > 0) { return; }
                      before = share(experiment);
                      start  = tops;
                  });
    const Outcome awake = this->run(undercut_text, [&](auto& experiment) { awake_tops = this->profile(experiment); });
    const auto    slid  = [&](const std::vector<double>& now)
    {
        double sum = 0;
        for (std::size_t i = 6; i < 12; ++i) { sum += start[i] - now[i]; } // 0.6 to 1.2 m: crest and upper slope
        return sum / 6;
    };
    double furthest = 0;
    for (std::size_t i = 0; i < tops.size(); ++i) { furthest = std::max(furthest, std::abs(tops[i] - awake_tops[i])); }
    test::report("share of points asleep before", before, 0.5, 0.1, "all beyond the wheel's distance");
    test::report("mean subsidence of the slope (m)", slid(tops), slid(awake_tops), 0.1 * slid(awake_tops),
                 "a tenth: it moves once, by what the wheel takes away at its foot");
    test::report("largest difference of the profile (m)", furthest, 0, 0.5 * spacing,
                 "half a cell, beside the wheel, which throws sand about");
    EXPECT_NEAR(before, 0.5, 0.1);
    EXPECT_GT(slid(awake_tops), 0.1 * spacing);
    EXPECT_NEAR(slid(tops), slid(awake_tops), 0.1 * slid(awake_tops));
    EXPECT_LT(furthest, 0.5 * spacing);
    this->expect_balanced("undercut slope", outcome, awake);
}

/// Damping is for settling: no sand sleeps in such a phase, and sleeping sand wakes.
TYPED_TEST(Sleep, NotInADampedPhase)
{
    test::Experiment<TypeParam> experiment(this->exec(),
                                           trench_text + sleep_text +
                                               "[[phase]]\nname = \"rest\"\nduration = 0.15\n"
                                               "[[phase]]\nname = \"settle\"\nduration = 0.02\ndamping = 0.3\n");
    auto&                       sand = experiment.simulation().sand();
    std::int64_t                most = 0, last = 0;
    experiment.run(
        [&](double)
        {
            last = sand.count() - sand.view().count;
            most = std::max(most, last);
        });
    EXPECT_EQ(most, sand.count());
    EXPECT_EQ(last, 0);
}

} // namespace sleep_test
