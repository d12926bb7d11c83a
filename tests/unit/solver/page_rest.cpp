#include <algorithm>

#include <gtest/gtest.h>

#include "kernels/mpm/pages/page_key.hpp"
#include "solver/sand/page_rest.hpp"

// Selection of pages that may sleep, on sets of pages written by hand.
namespace
{

using namespace tread;
using namespace tread::solver;

constexpr RestRule rule{0.1, 0.35, 0.01, 0.05};
constexpr int      row_pages = 40;

std::uint64_t page(int x) { return mpm::page_key({x, 0, 0}); }

/// A named body of 0.2 m, with the two pages of slack.
BodyReach body_at(double x)
{
    const double wakes = 0.2 + rule.distance;
    return {{x, 0.05, 0.05}, wakes, wakes + 2 * rule.page_edge};
}

/// A row of 40 pages along x, four metres, all at rest for a long time, none asleep.
RestState quiet_row()
{
    RestState state;
    for (int x = 0; x < row_pages; ++x) { state.awake.push_back({page(x), 0.0, 1.0}); }
    return state;
}

/// Pages of `keys` as numbers along the row, ascending.
std::vector<int> along(const std::vector<std::uint64_t>& keys)
{
    std::vector<int> x;
    for (const std::uint64_t key : keys) { x.push_back(mpm::page_coordinates(key).x); }
    std::sort(x.begin(), x.end());
    return x;
}

std::vector<int> range(int first, int last)
{
    std::vector<int> all;
    for (int x = first; x <= last; ++x) { all.push_back(x); }
    return all;
}

/// State after a check: pages fall asleep or wake.
RestState after(const RestState& before, const std::vector<std::uint64_t>& asleep)
{
    RestState state = before;
    state.asleep    = asleep;
    state.pressed.clear();
    state.awake.clear();
    for (int x = 0; x < row_pages; ++x)
    {
        if (!std::binary_search(asleep.begin(), asleep.end(), page(x))) { state.awake.push_back({page(x), 0.0, 1.0}); }
    }
    return state;
}

TEST(PageRest, AllOfAQuietBedSleeps)
{
    const auto asleep = choose_asleep(rule, quiet_row());
    EXPECT_EQ(along(asleep), range(0, row_pages - 1));
    EXPECT_TRUE(std::is_sorted(asleep.begin(), asleep.end()));
}

TEST(PageRest, WhatHasNotRestedLongKeepsThreePagesAroundItFromSleep)
{
    RestState state       = quiet_row();
    state.awake[20].quiet = 0.04;
    auto       expected   = range(0, 16);
    const auto beyond     = range(24, row_pages - 1);
    expected.insert(expected.end(), beyond.begin(), beyond.end());
    EXPECT_EQ(along(choose_asleep(rule, state)), expected);
}

/// The body's sphere ends at 0.55 m; 0.35 m of distance and two pages of slack make 1.1 m: pages from number 11 on.
TEST(PageRest, WhatIsNearABodyDoesNotSleep)
{
    RestState state = quiet_row();
    state.bodies    = {body_at(0.35)};
    EXPECT_EQ(along(choose_asleep(rule, state)), range(11, row_pages - 1));
}

/// Two bodies 3.3 m apart: the second one's range begins at 3.64 - 0.2 - 0.35 - 0.2 = 2.89 m, in page 28.
TEST(PageRest, SandBetweenBodiesFarApartSleeps)
{
    RestState state = quiet_row();
    state.bodies    = {body_at(0.35), body_at(3.64)};
    EXPECT_EQ(along(choose_asleep(rule, state)), range(11, 27));
}

TEST(PageRest, PagesWakeInSlicesBeforeABodyReachesThem)
{
    RestState state = quiet_row();
    state.bodies    = {body_at(0.35)};
    state           = after(state, choose_asleep(rule, state));

    state.bodies[0].centre[0] = 0.54; // its range ends at 1.09 m
    EXPECT_EQ(along(choose_asleep(rule, state)), range(11, row_pages - 1));
    state.bodies[0].centre[0] = 0.56; // and at 1.11 m: two pages more than necessary wake
    EXPECT_EQ(along(choose_asleep(rule, state)), range(14, row_pages - 1));
}

/// Between two checks a body that wakes has the pages near it wake, with the slices of a check.
TEST(PageRest, ABodyThatWakesWakesThePagesNearIt)
{
    const std::vector<std::uint64_t> all      = choose_asleep(rule, quiet_row());
    auto                             expected = range(0, 11);
    const auto                       beyond   = range(28, row_pages - 1);
    expected.insert(expected.end(), beyond.begin(), beyond.end());
    EXPECT_EQ(along(stay_asleep(rule, all, {body_at(2.0)})), expected); // 0.55 m and two pages
    EXPECT_EQ(stay_asleep(rule, all, {body_at(-0.6)}), all);            // 5 cm too far
    EXPECT_EQ(stay_asleep(rule, all, {}), all);
    EXPECT_TRUE(stay_asleep(rule, {}, {body_at(2.0)}).empty());
}

TEST(PageRest, WhatTheBodyHasLeftSleepsAgain)
{
    RestState state = quiet_row();
    state.bodies    = {body_at(0.35)};
    state           = after(state, choose_asleep(rule, state));
    state.bodies    = {body_at(3.0)};
    auto expected   = range(0, 21);
    expected.insert(expected.end(), {38, 39});
    EXPECT_EQ(along(choose_asleep(rule, state)), expected);
}

TEST(PageRest, AMovingPageWakesTwoAround)
{
    RestState state = after(quiet_row(), choose_asleep(rule, quiet_row()));
    state.awake     = {{page(row_pages), 0.02, 0.0}}; // beside the last
    EXPECT_EQ(along(choose_asleep(rule, state)), range(0, row_pages - 3));
    state.awake[0].speed = 0.009;
    EXPECT_EQ(along(choose_asleep(rule, state)), range(0, row_pages - 1));
}

TEST(PageRest, AChangedLoadWakesThePageAndThoseBesideIt)
{
    RestState state     = after(quiet_row(), choose_asleep(rule, quiet_row()));
    state.pressed       = {page(20)};
    auto       expected = range(0, 18);
    const auto beyond   = range(22, row_pages - 1);
    expected.insert(expected.end(), beyond.begin(), beyond.end());
    EXPECT_EQ(along(choose_asleep(rule, state)), expected);
}

/// All points are sorted when a page falls asleep: that does not pay for two of forty pages, but for three.
TEST(PageRest, AFewPagesWaitForOthers)
{
    const auto with_quiet = [](std::size_t pages)
    {
        RestState state = quiet_row();
        for (std::size_t x = pages; x < state.awake.size(); ++x) { state.awake[x].quiet = 0; }
        return along(choose_asleep(rule, state));
    };
    EXPECT_EQ(with_quiet(5), std::vector<int>{});
    EXPECT_EQ(with_quiet(6), range(0, 2));
}

/// Pages above and beside count like those along the row.
TEST(PageRest, PagesAreNearInAllDirections)
{
    RestState state;
    for (int z = 0; z < 8; ++z)
    {
        for (int x = 0; x < 8; ++x) { state.awake.push_back({mpm::page_key({x, 3, z}), 0.0, 1.0}); }
    }
    std::sort(state.awake.begin(), state.awake.end(),
              [](const AwakePage& a, const AwakePage& b) { return a.key < b.key; });
    for (AwakePage& at : state.awake)
    {
        if (at.key == mpm::page_key({0, 3, 0})) { at.quiet = 0; }
    }
    const auto asleep = choose_asleep(rule, state);
    EXPECT_EQ(asleep.size(), 64U - 16U);
    EXPECT_FALSE(std::binary_search(asleep.begin(), asleep.end(), mpm::page_key({3, 3, 3})));
    EXPECT_TRUE(std::binary_search(asleep.begin(), asleep.end(), mpm::page_key({3, 3, 4})));
    EXPECT_TRUE(std::binary_search(asleep.begin(), asleep.end(), mpm::page_key({4, 3, 0})));
}

} // namespace
