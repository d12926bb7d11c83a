#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "strewn_bed.hpp"

// Sand and rocks that sleep together, compared with the same bed that may not (docs/sleep.md).
namespace
{

using namespace tread;
using test::Bed;
using test::StrewnBed;

template<class Exec>
class StrewnSleep : public StrewnBed<Exec>
{
};
TYPED_TEST_SUITE(StrewnSleep, test::Backends, test::BackendNames);

template<class Exec>
class FullSizeStrewnSleep : public StrewnBed<Exec>
{
};
TYPED_TEST_SUITE(FullSizeStrewnSleep, test::Backends, test::BackendNames);

/// Rocks on and in sand: all of it falls asleep; from then on nothing is computed, and nothing changes its place by a
/// bit.
TYPED_TEST(FullSizeStrewnSleep, ABedAtRestSleepsEntirely)
{
    const std::string text = test::short_bed + test::phase("settle", 0.3, test::settled) + test::phase("rest", 0, 0.5);
    std::vector<double>       bodies, points;
    std::vector<Vec3<double>> forces;
    std::int64_t              launches = 0;
    double                    since    = 0;
    const Bed                 outcome  = this->run(text + test::strewn_sleep_text,
                                                   [&](auto& run, double time)
                                                   {
                                      if (since > 0 || !this->all_asleep(run)) { return; }
                                      since    = time;
                                      bodies   = run.simulation().body_fields().position;
                                      points   = run.simulation().point_fields().position;
                                      forces   = this->forces(run);
                                      launches = this->launches();
                                  });
    const std::int64_t        more     = this->launches() - launches;
    const Bed                 awake    = this->run(text);
    const double              spell    = test::settled + 0.5 - since;
    const double              most     = test::largest_difference(outcome.bodies, awake.bodies);
    const double              creep    = 2 * test::rock_speed * spell;
    std::cout << "all asleep for " << spell << " s\n";
    ASSERT_GT(since, 0);
    EXPECT_GT(spell, 0.1);
    test::report("launches since", static_cast<double>(more), 0, 0, "nothing is computed");
    EXPECT_EQ(more, 0);
    EXPECT_EQ(outcome.bodies, bodies);
    EXPECT_EQ(outcome.points, points);
    EXPECT_EQ(outcome.forces, forces);
    test::report("largest difference of a rock's coordinate (m)", most, 0, creep,
                 "a rock that is held was slower than rock_speed, and its sand likewise, for as long as it slept");
    EXPECT_LT(most, creep);
    EXPECT_EQ(awake.most_rocks, 0);
    this->expect_balanced("strewn bed at rest", outcome, awake);
}

/// A new phase wakes rocks and the sand around them in one step, and the contacts press as they did.
TYPED_TEST(StrewnSleep, ANewPhaseWakesRocksAndTheirSandTogether)
{
    const std::string text = test::short_bed + test::phase("settle", 0.3, test::settled) + test::phase("rest", 0, 0.4) +
                             test::phase("again", 0, 0.02);
    constexpr double          turn = test::settled + 0.4;
    std::vector<Vec3<double>> before, after;
    double                    asleep  = 0;
    auto                      nearest = this->nowhere;
    std::int64_t              rocks   = -1;
    this->run(text + test::strewn_sleep_text,
              [&](auto& run, double time)
              {
                  if (time < turn + 1e-9)
                  {
                      asleep = this->share_asleep(run);
                      before = this->forces(run);
                  }
                  else if (rocks < 0)
                  {
                      rocks   = run.simulation().rocks_asleep();
                      after   = this->forces(run);
                      nearest = this->nearest_sleeping_point(run);
                  }
              });
    double most = 0;
    for (std::size_t b = 0; b < before.size(); ++b)
    {
        most = std::max(most, (after[b] - before[b]).norm() / before[b].norm());
    }
    test::report("share of points asleep before", asleep, 1, 0, "the bed is at rest");
    test::report("rocks asleep in the first step", static_cast<double>(rocks), 0, 0, "all wake");
    test::report(
        "largest change of the force on a rock, over the force", most, 0, 0.02,
        "contacts go on from what they held: a rock that was off balance by the 10 % of rock_load moves 0.24 um "
        "in a step of 0.7 ms, of 20 um that it is pressed into its sand");
    EXPECT_EQ(asleep, 1);
    EXPECT_EQ(rocks, 0);
    this->expect_awake_around(nearest);
    EXPECT_LT(most, 0.02);
}

/// Gravity turns: all wakes at once and goes the way of what never slept.
TYPED_TEST(FullSizeStrewnSleep, GravityTurns)
{
    const std::string text = test::short_bed + test::phase("settle", 0.3, test::settled) + test::phase("rest", 0, 0.4) +
                             test::phase("turn", 0, 0.1) + "gravity = [6.0, 0.0, -7.7]\n";
    constexpr double turn   = test::settled + 0.4;
    double           before = 0, after = 0;
    const Bed        outcome = this->run(text + test::strewn_sleep_text,
                                         [&](auto& run, double time)
                                         {
                                      double& share = time < turn + 1e-9 ? before : after;
                                      share         = std::max(share, this->share_asleep(run));
                                  });
    const Bed        awake   = this->run(text);
    const double     most    = test::largest_difference(outcome.bodies, awake.bodies);
    const double     creep   = 2 * test::rock_speed * 0.4;
    test::report("share of points asleep before", before, 1, 0, "the bed is at rest");
    test::report("share of points asleep after", after, 0, 0, "all wakes");
    test::report("largest difference of a rock's coordinate after 0.1 s (m)", most, 0, creep,
                 "what creep below rock_speed was held during the phase before");
    EXPECT_EQ(before, 1);
    EXPECT_EQ(after, 0);
    EXPECT_LT(most, creep);
    this->expect_balanced("gravity turns", outcome, awake);
}

/// A rock falls on the sleeping bed: what it hits wakes, sand included, before it is there; what is far never does.
TYPED_TEST(FullSizeStrewnSleep, ARockFallsOnASleepingStrewnBed)
{
    constexpr double  release = test::settled + 0.4; ///< s
    const std::string text    = test::long_bed + test::held_stone_text +
                             "[[phase]]\nname = \"settle\"\ndamping = 0.3\nduration = 0.3\nhold = [\"stone\"]\n" +
                             test::phase("fall", 0, 1.0);
    double              share   = 0;
    auto                nearest = this->nowhere;
    std::vector<double> place;
    std::int64_t        woken = 0, last = 0;
    const auto          fall = [&](const std::string& scene, auto watch)
    {
        return this->run(scene, watch,
                         [](double time, auto& commands)
                         {
                             if (time < release) { commands[0].locked = dem::lock_all; }
                         });
    };
    const Bed    outcome = fall(text + test::strewn_sleep_text,
                                [&](auto& run, double time)
                                {
                                 const std::int64_t rocks = run.simulation().rocks_asleep();
                                 woken += std::max<std::int64_t>(last - rocks, 0);
                                 last = rocks;
                                 if (time < release)
                                 {
                                     share = this->share_asleep(run);
                                     place = run.simulation().body_fields().position;
                                 }
                                 else { nearest.include(this->nearest_sleeping_point(run)); }
                             });
    const Bed    awake   = fall(text, [](auto&, double) {});
    const double stone = outcome.bodies[2], stone_awake = awake.bodies[2];
    const auto   far = test::furthest_rock(place, 1);
    test::report("share of points asleep at the release", share, 1, 0, "the stone hangs high above");
    test::report("height of the stone (m)", stone, stone_awake, 0.25 * test::diameter,
                 "a quarter of its size: it may roll off a rock by chance");
    test::report("shift of the furthest rock (m)", test::shift_of(far, place, outcome.bodies), 0, 0,
                 "out of reach: it sleeps on");
    std::cout << "woken " << woken << ", asleep at the end " << last << "\n";
    EXPECT_EQ(share, 1);
    this->expect_awake_around(nearest);
    EXPECT_GT(woken, 0);
    EXPECT_NEAR(stone, stone_awake, 0.25 * test::diameter);
    EXPECT_EQ(test::shift_of(far, place, outcome.bodies), 0);
    this->expect_balanced("rock on a strewn bed", outcome, awake);
}

/// A roller falls on one end of the sleeping bed and drives half a metre: around it all is awake, beyond its
/// neighbourhood nothing is.
TYPED_TEST(FullSizeStrewnSleep, AWheelWakesItsNeighbourhoodOnly)
{
    constexpr double release = test::settled + 0.3; ///< s
    const auto [text, reach] = std::pair(test::long_bed + test::strewn_roller_text, test::neighbourhood);
    std::vector<double> place;
    double              share = 0, furthest = 0, asleep = 0, steps = 0;
    auto                nearest = this->nowhere;
    const auto          drive   = [&](const std::string& scene, auto watch)
    {
        return this->run(scene, watch,
                         [](double time, auto& commands)
                         {
                             if (time < release) { commands[0].locked = dem::lock_all; }
                             else
                             {
                                 const double spin = 10.0 * std::min(1.0, (time - release) / 0.2);
                                 commands[0].spin  = spin;
                                 commands[0].locked |= dem::lock_pitch;
                             }
                         });
    };
    std::vector<std::int32_t> before;
    const Bed                 outcome = drive(text + test::trembling_sleep_text,
                                              [&](auto& run, double time)
                                              {
                                  const auto position = run.simulation().body_fields().position;
                                  if (time < release)
                                  {
                                      share  = this->share_asleep(run);
                                      place  = position;
                                      before = this->sleepers(run);
                                      return;
                                  }
                                  const auto now = this->sleepers(run);
                                  for (std::size_t b = 1; b < now.size(); ++b)
                                  {
                                      if (before[b] == 0 || now[b] != 0) { continue; }
                                      furthest = std::max(furthest, std::abs(position[3 * b] - position[0]));
                                  }
                                  before = now;
                                  asleep += this->share_asleep(run);
                                  steps += 1;
                                  nearest.include(this->nearest_sleeping_point(run));
                              });
    const Bed                 awake   = drive(text, [](auto&, double) {});
    const auto                far     = test::furthest_rock(place, 1);
    std::cout << "asleep on the mean of the drive " << asleep / steps << ", driven " << outcome.bodies[0] - place[0]
              << " m\n";
    test::report("share of points asleep at the release", share, 1, 0, "the roller hangs above");
    test::report("furthest rock that woke (m)", furthest, reach, 0,
                 "beyond the sand that is awake around a wheel nothing changes the load on a rock");
    test::report("shift of the furthest rock (m)", test::shift_of(far, place, outcome.bodies), 0, 0, "it sleeps on");
    EXPECT_EQ(share, 1);
    EXPECT_GT(asleep / steps, 0.3);
    EXPECT_GT(furthest, 0);
    EXPECT_LT(furthest, reach);
    this->expect_awake_around(nearest);
    EXPECT_EQ(test::shift_of(far, place, outcome.bodies), 0);
    this->expect_balanced("wheel on a strewn bed", outcome, awake);
}

} // namespace
