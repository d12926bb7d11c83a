#include <algorithm>
#include <cmath>
#include <vector>

#include "rock_scenes.hpp"

// Rocks that may sleep, compared with the same rocks that may not (docs/sleep.md#rocks-that-sleep).
namespace
{

using namespace tread;

constexpr double diameter = 0.1; ///< m, of the rocks
constexpr double settled  = 1.5; ///< s, end of the damped phase

const std::string sleep_text = "[sleep]\nrock_speed = 2e-3\n";

const std::string clast_text = R"(
[[shape]]
name      = "clast"
generate  = { kind = "rock", seed = 3, aspect = 0.7, sphericity = 0.9, nodes = 42 }
sdf_cells = 20
)";

std::string rain(int count, const std::string& box)
{
    return fmt::format("[[rocks]]\nshape = \"clast\"\nmaterial = \"stone\"\ncount = {}\ndiameter = {}\n"
                       "placement = \"rain\"\nregion = {{ box = {} }}\n",
                       count, diameter, box);
}

/// A pile of rocks in a bin three rocks wide.
std::string pile_text()
{
    return test::rock_domain({0.35, 0.35, 1.6}, 0, "x = \"slip\", y = \"slip\", bottom = \"fixed\", top = \"open\"",
                             "linear_overlap = 1e-2") +
           test::stone(1e7, 0.5, 0.5) + clast_text + rain(20, "[[0, 0, 0], [0.35, 0.35, 0.7]]");
}

/// A rock that is held above the pile while it settles.
const std::string held_rock_text = fmt::format(R"(
[[body]]
name     = "stone"
shape    = "clast"
material = "stone"
diameter = {}
mass     = 1.4
position = [0.175, 0.175, 1.2]
)",
                                               diameter);

/// Result of a run.
struct Outcome
{
    std::vector<double> position;     ///< m, of all bodies at the end
    std::int64_t        most     = 0; ///< most sleepers
    std::int64_t        last     = 0; ///< sleepers at the end
    std::int64_t        woken    = 0; ///< sum over steps of sleepers that woke
    double              energy   = 0; ///< unaccounted, over the largest exchange
    double              momentum = 0;
};

double mean_height(const std::vector<double>& position)
{
    double sum = 0;
    for (std::size_t i = 2; i < position.size(); i += 3) { sum += position[i]; }
    return 3 * sum / static_cast<double>(position.size());
}

template<class Exec>
class RockSleep : public test::BackendTest<Exec>
{
protected:
    using Experiment = test::Experiment<Exec>;

    /// Calls `watch(experiment, time)` after every step.
    template<class Watch>
    Outcome run(Experiment& experiment, Watch watch)
    {
        auto&        simulation = experiment.simulation();
        Outcome      outcome;
        std::int64_t before = 0;
        experiment.run(
            [&](double time)
            {
                const std::int64_t asleep = simulation.rocks_asleep();
                outcome.woken += std::max<std::int64_t>(before - asleep, 0);
                outcome.most = std::max(outcome.most, asleep);
                before       = asleep;
                watch(experiment, time);
            });
        outcome.last             = before;
        outcome.position         = simulation.body_fields().position;
        const solver::Census now = simulation.census();
        simulation.ledger().energy(now);
        simulation.ledger().balance(now);
        outcome.energy   = std::abs(simulation.ledger().errors().energy);
        outcome.momentum = simulation.ledger().errors().momentum;
        return outcome;
    }

    Outcome run(const std::string& text)
    {
        Experiment experiment(this->exec(), text);
        return run(experiment, [](Experiment&, double) {});
    }

    /// Number of launches of the contacts and the motion of bodies so far.
    std::int64_t substep_launches() const
    {
        std::int64_t sum = 0;
        for (const char* name : {"body contacts", "nodes found", "move bodies", "substeps of bodies"})
        {
            const auto found = this->counters.launches().find(name);
            if (found != this->counters.launches().end()) { sum += found->second; }
        }
        return sum;
    }

    static void expect_balanced(const std::string& what, const Outcome& outcome, const Outcome& awake)
    {
        test::report(what + ": energy unaccounted", outcome.energy, awake.energy, 2e-3,
                     "as without sleep, since the ledger accounts for what falls asleep; impacts part by chance");
        test::report(what + ": momentum error", outcome.momentum, awake.momentum, 1e-12,
                     "the impulse that holds sleepers is accounted for; fp64");
        EXPECT_LT(std::abs(outcome.energy - awake.energy), 2e-3);
        EXPECT_LT(outcome.momentum, 1e-12);
    }
};
TYPED_TEST_SUITE(RockSleep, test::Backends, test::BackendNames);

/// All rocks fall asleep; from then on no contact is computed, no rock is moved, and none changes its place by a bit.
TYPED_TEST(RockSleep, APileAtRestCostsNothing)
{
    const std::string           text = pile_text() + test::phase("settle", 0.3, settled) + test::phase("rest", 0, 1.0);
    test::Experiment<TypeParam> experiment(this->exec(), text + sleep_text);
    std::vector<double>         place;
    std::int64_t                launches = 0, steps = 0;
    const Outcome               outcome = this->run(experiment,
                                                    [&](auto& run, double)
                                                    {
                                          if (run.simulation().rocks_asleep() < 20) { return; }
                                          ++steps;
                                          if (!place.empty()) { return; }
                                          place    = run.simulation().body_fields().position;
                                          launches = this->substep_launches();
                                      });
    const std::int64_t          more    = this->substep_launches() - launches;
    const Outcome               awake   = this->run(text);
    std::cout << steps << " steps asleep\n";
    test::report("rocks asleep at the end", static_cast<double>(outcome.last), 20, 0, "all");
    test::report("launches of substeps since", static_cast<double>(more), 0, 0, "nothing is computed");
    ASSERT_EQ(outcome.last, 20);
    EXPECT_GT(steps, 20);
    EXPECT_EQ(more, 0);
    EXPECT_EQ(outcome.position, place);
    EXPECT_EQ(awake.most, 0);
    this->expect_balanced("pile at rest", outcome, awake);
}

/// A rock falls 0.6 m onto a sleeping pile: what it hits wakes, and all comes to rest as without sleep.
TYPED_TEST(RockSleep, ARockFallsOnASleepingPile)
{
    const std::string text =
        pile_text() + held_rock_text +
        "[[phase]]\nname = \"settle\"\ndamping = 0.3\nduration = 1.5\nhold = [\"stone\"]\n" +
        test::phase("fall", 0, 3.0); // ten other beds: none to 20 asleep after 1.5 s, 18 to 20 after 3 s
    const Outcome outcome = this->run(text + sleep_text), awake = this->run(text);
    const double  height = mean_height(outcome.position), expected = mean_height(awake.position);
    const double  stone = outcome.position[2], stone_awake = awake.position[2];
    test::report("mean height (m)", height, expected, 0.05 * diameter,
                 "a twentieth of a rock: impacts of irregular rocks part by chance");
    test::report("height of the rock that fell (m)", stone, stone_awake, 0.5 * diameter, "half a rock, by chance");
    std::cout << "asleep at most " << outcome.most << ", at the end " << outcome.last << ", woken " << outcome.woken
              << "\n";
    EXPECT_EQ(outcome.most, 20);
    EXPECT_GT(outcome.woken, 5);
    EXPECT_GT(outcome.last, 10);
    EXPECT_NEAR(height, expected, 0.05 * diameter);
    EXPECT_NEAR(stone, stone_awake, 0.5 * diameter);
    this->expect_balanced("rock on a pile", outcome, awake);
}

/// A slab is pulled out from under sleeping rocks, within a phase: they fall to the floor. Of twenty such pairs ten
/// were both asleep 0.4 s after the damped phase, and of twelve eleven after 2 s: the others rocked on.
TYPED_TEST(RockSleep, WhatSleptOnAPulledSlabFalls)
{
    const std::string text =
        test::rock_domain({0.8, 0.2, 1.2}, 0, "x = \"open\", y = \"slip\", bottom = \"fixed\", top = \"open\"",
                          "linear_overlap = 1e-2") +
        test::stone(1e7, 0.5, 0.3) + clast_text + rain(2, "[[0.3, 0.02, 0.34], [0.5, 0.18, 0.7]]") +
        "[[shape]]\nname = \"slab\"\ngenerate = { kind = \"box\", size = [0.7, 0.2, 0.04] }\n"
        "[[body]]\nname = \"slab\"\nshape = \"slab\"\nmaterial = \"stone\"\nmass = 5.0\nposition = [0.4, 0.1, 0.3]\n"
        "[[phase]]\nname = \"settle\"\ndamping = 0.3\nduration = 1.0\nhold = [\"slab\"]\n"
        "[[phase]]\nname = \"pull\"\nduration = 3.0\nhold = [\"slab\"]\n";
    constexpr double start  = 2.9; ///< s
    std::int64_t     asleep = 0;
    double           lowest = 1;
    const auto       pull   = [&](const std::string& scene)
    {
        test::Experiment<TypeParam> experiment(this->exec(), scene);
        experiment.steer(
            [&](auto& commands)
            {
                if (experiment.time() >= start) { commands[0].forward = 6.0; }
            });
        return this->run(experiment,
                         [&](auto& run, double time)
                         {
                             if (time >= start) { return; }
                             asleep              = std::max(asleep, run.simulation().rocks_asleep());
                             const auto position = run.simulation().body_fields().position;
                             lowest              = std::min(position[5], position[8]);
                         });
    };
    const Outcome awake = pull(text), outcome = pull(text + sleep_text);
    const double  highest = std::max(outcome.position[5], outcome.position[8]);
    test::report("rocks asleep before the pull", static_cast<double>(asleep), 2, 0, "both lie on the slab");
    test::report("highest centre at the end (m)", highest, 0.5 * diameter, 0.1,
                 "on the floor, or one on the other; before, over 0.32 m");
    EXPECT_EQ(asleep, 2);
    EXPECT_GT(lowest, 0.32);
    EXPECT_LT(highest, 0.5 * diameter + 0.1);
    this->expect_balanced("pulled slab", outcome, awake);
}

/// Gravity turns: all rocks wake at once and go the way of those that never slept.
TYPED_TEST(RockSleep, GravityTurns)
{
    // In some piles a rock topples once damping ends, for half a second.
    constexpr double  rest = 1.0, turn = settled + rest;
    const std::string text = pile_text() + test::phase("settle", 0.3, settled) + test::phase("rest", 0, rest) +
                             test::phase("turn", 0, 0.1) + "gravity = [9.81, 0.0, 0.0]\n";
    test::Experiment<TypeParam> experiment(this->exec(), text + sleep_text);
    std::int64_t                before = 0, after = 20;
    const Outcome               outcome = this->run(experiment,
                                                    [&](auto& run, double time)
                                                    {
                                          if (time < turn) { before = run.simulation().rocks_asleep(); }
                                          else { after = std::min(after, run.simulation().rocks_asleep()); }
                                      });
    const Outcome               awake   = this->run(text);
    double                      most    = 0;
    for (std::size_t i = 0; i < awake.position.size(); ++i)
    {
        most = std::max(most, std::abs(outcome.position[i] - awake.position[i]));
    }
    test::report("largest difference of a position after 0.1 s (m)", most, 0, 0.01 * diameter,
                 "rocks fall by 0.05 m meanwhile; they start from places that differ by what the tremor of rest moved");
    EXPECT_EQ(before, 20);
    EXPECT_EQ(after, 0);
    EXPECT_LT(most, 0.01 * diameter);
    this->expect_balanced("gravity turns", outcome, awake);
}

/// A rock on sand falls asleep, while the sand is computed: both keep their place, and the balances close.
TYPED_TEST(RockSleep, ARockOnSand)
{
    const std::string text = std::string(test::sand_text) + "[numerics]\nprecision = \"double\"\n" +
                             test::stone(1e7, 0.5, 0.5) + clast_text +
                             "[[rocks]]\nshape = \"clast\"\nmaterial = \"stone\"\ncount = 2\ndiameter = 0.1\n"
                             "placement = \"rain\"\nregion = { box = [[0.0, 0.0, 0.21], [0.4, 0.4, 0.45]] }\n" +
                             test::phase("settle", 0.3, 0.5) + test::phase("lie", 0, 0.4);
    const Outcome outcome = this->run(text + "[sleep]\nrock_speed = 1e-2\n"), awake = this->run(text);
    const double  height = mean_height(outcome.position), expected = mean_height(awake.position);
    test::report("mean height of the rocks (m)", height, expected, 0.01 * diameter,
                 "awake ones creep at 2 mm/s for the 0.3 s that the others sleep");
    test::report("rocks asleep", static_cast<double>(outcome.last), 2, 0, "both");
    EXPECT_EQ(outcome.last, 2);
    EXPECT_NEAR(height, expected, 0.01 * diameter);
    this->expect_balanced("rocks on sand", outcome, awake);
}

} // namespace
