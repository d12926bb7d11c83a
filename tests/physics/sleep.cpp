#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "harness.hpp"

// Sand that sleeps, beside the same that does not.
namespace
{

using namespace tread;

constexpr double spacing = 0.05; ///< m
constexpr double length  = 3.2;  ///< m

/// A trench of sand, 3.2 x 0.4 x 0.2 m, as geostatic stress has it.
const std::string trench_text = R"(
title = "trench"
[domain]
size    = [3.2, 0.4, 0.8]
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
[[terrain]]
material = "sand"
region   = { box = [[0.0, 0.0, 0.0], [3.2, 0.4, 0.2]] }
)";

const std::string sleep_text = R"(
[sleep]
distance = 0.4
)";

/// A roller that falls 6 cm and then drives.
const std::string roller_text = R"(
[[material]]
name    = "steel"
model   = "elastic"
density = 7800.0
young   = 1.0e9
poisson = 0.3
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
duration = 0.8
)";

/// How a scene went.
struct Outcome
{
    std::vector<double> row; ///< what is compared
    double              steps    = 0;
    double              sleeper  = 0; ///< mean share of the points that slept
    double              most     = 0; ///< largest
    double              energy   = 0; ///< unaccounted, over the largest exchange
    double              momentum = 0;
    double              mass     = 0;
};

template<class Exec>
class Sleep : public test::BackendTest<Exec>
{
protected:
    /// `watch(experiment)` after every step.
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

    /// The books close as they do without sleep.
    static void expect_balanced(const std::string& what, const Outcome& outcome, const Outcome& awake)
    {
        test::report(what + ": energy unaccounted", outcome.energy, awake.energy, 1e-3,
                     "what falls asleep gives its motion up, and that is booked; without sleep as said");
        test::report(what + ": momentum error", outcome.momentum, awake.momentum, 1e-6,
                     "what holds the sleeping sand is booked as a wall's impulse; fp64");
        EXPECT_LT(outcome.energy, std::max(1e-3, 2 * awake.energy));
        EXPECT_LT(outcome.momentum, std::max(1e-6, 2 * awake.momentum));
        EXPECT_LT(outcome.mass, 1e-12);
    }
};
TYPED_TEST_SUITE(Sleep, test::Backends, test::BackendNames);

/// Nothing but sand at rest: all of it falls asleep at the first look, and nothing is left to compute.
TYPED_TEST(Sleep, ABedAtRestSleepsAltogether)
{
    const std::string text    = trench_text + "[[phase]]\nname = \"rest\"\nduration = 0.3\n";
    const Outcome     outcome = this->run(text + sleep_text), awake = this->run(text);
    std::cout << "asleep at most " << outcome.most << ", on the mean " << outcome.sleeper << "\n";
    EXPECT_EQ(outcome.most, 1);
    EXPECT_EQ(awake.most, 0);
    this->expect_balanced("bed at rest", outcome, awake);
}

/// The roller drives 0.2 m, in a trench of which it stirs a fifth.
TYPED_TEST(Sleep, ARollerFarAwayFeelsNothing)
{
    const auto run = [&](const std::string& text, std::vector<double>& heights)
    {
        return this->run(text, [&](auto& experiment)
                         { heights.push_back(experiment.simulation().named_bodies().front().position[2]); });
    };
    std::vector<double> heights, awake_heights;
    const Outcome       outcome = run(trench_text + roller_text + sleep_text, heights);
    const Outcome       awake   = run(trench_text + roller_text, awake_heights);
    const double        sinkage = 0.3 - awake_heights.back(), other = 0.3 - heights.back();
    std::cout << "asleep at most " << outcome.most << ", on the mean " << outcome.sleeper << "\n";
    constexpr double tolerance = 0.02;
    test::report("sinkage (m)", other, sinkage, tolerance * sinkage,
                 "a single drive of 0.2 m in coarse sand; docs/sleep.md has the means over ten metres");
    EXPECT_GT(outcome.most, 0.5);
    EXPECT_NEAR(other, sinkage, tolerance * sinkage);
    this->expect_balanced("roller", outcome, awake);
}

/// At every step what sleeps is as far from the roller as it has to be, less what the roller goes between two looks.
TYPED_TEST(Sleep, WakesBeforeTheRollerComes)
{
    test::Experiment<TypeParam> experiment(this->exec(), trench_text + roller_text + sleep_text);
    auto&                       simulation = experiment.simulation();
    double                      nearest    = 1e9;
    int                         looks = 0, woke = 0;
    std::int64_t                before = 0;
    experiment.run(
        [&](double)
        {
            if (++looks % 20 != 0) { return; }
            const std::int64_t asleep = simulation.sand().count() - simulation.sand().view().count;
            woke += asleep < before;
            before          = asleep;
            const double at = simulation.named_bodies().front().position[0];
            const auto   x  = simulation.sand().positions();
            for (std::size_t i = x.size() - static_cast<std::size_t>(asleep); i < x.size(); ++i)
            {
                nearest = std::min(nearest, std::abs(x[i][0] - at));
            }
        });
    constexpr double reach = 0.1 + 0.4;
    test::report("nearest sleeping point, along x (m)", nearest, reach, 0.1,
                 "at least the roller's radius and 0.4 m, less 0.8 m/s times a look's 0.05 s");
    EXPECT_GT(nearest, reach - 0.05);
    EXPECT_GT(woke, 0);
}

/// A column collapses over a bed that sleeps: it wakes what it comes to, and lies in the end as without.
TYPED_TEST(Sleep, ACollapseBesideSleepingPagesGoesItsWay)
{
    const auto profile = [](auto& experiment)
    {
        std::vector<double> top(static_cast<std::size_t>(length / (2 * spacing)), 0.0);
        for (const Vec3<double>& x : experiment.simulation().sand().positions())
        {
            const auto column = static_cast<std::size_t>(std::clamp(x[0], 0.0, length - 1e-6) / (2 * spacing));
            top[column]       = std::max(top[column], x[2]);
        }
        return top;
    };
    std::vector<double> tops, awake_tops;
    const Outcome outcome = this->run(trench_text + column_text + sleep_text, [&](auto& e) { tops = profile(e); });
    const Outcome awake   = this->run(trench_text + column_text, [&](auto& e) { awake_tops = profile(e); });
    std::cout << "asleep at most " << outcome.most << ", on the mean " << outcome.sleeper << "\n";
    double furthest = 0;
    for (std::size_t i = 0; i < tops.size(); ++i) { furthest = std::max(furthest, std::abs(tops[i] - awake_tops[i])); }
    test::report("largest difference of the profile (m)", furthest, 0, 0.5 * spacing,
                 "half a cell; single grains on a slope that has stopped lie where chance has put them");
    EXPECT_GT(outcome.most, 0.3);
    EXPECT_LT(furthest, 0.5 * spacing);
    this->expect_balanced("collapse", outcome, awake);
}

/// Damping is for settling: nothing sleeps in such a phase, and what slept wakes.
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

} // namespace
