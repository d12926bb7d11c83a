#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/dem/joints/elimination.hpp"

// The order in which rows of joints are eliminated.
namespace tread::test
{
namespace
{

dem::Joint between(std::int32_t a, std::int32_t b)
{
    dem::Joint joint{};
    joint.kind    = dem::joint_revolute;
    joint.body[0] = a;
    joint.body[1] = b;
    return joint;
}

std::vector<std::int32_t> items_of(const dem::IndexLists& lists, std::int32_t k)
{
    const auto at = static_cast<std::size_t>(k);
    return {lists.item.begin() + lists.first[at], lists.item.begin() + lists.first[at + 1]};
}

/// A rocker-bogie as in configs/rover: bodies 0 chassis, 1 and 2 rockers, 3 and 4 bogies, 5 to 8 uprights, 9 to 14
/// wheels.
std::vector<dem::Joint> rocker_bogie()
{
    dem::Joint differential{};
    differential.kind       = dem::joint_differential;
    differential.couples[0] = 0;
    differential.couples[1] = 1;
    return {between(0, 1),  between(0, 2),  differential,   between(1, 3),  between(2, 4),
            between(1, 5),  between(2, 6),  between(3, 7),  between(4, 8),  between(5, 9),
            between(6, 10), between(3, 11), between(4, 12), between(7, 13), between(8, 14)};
}

// All six wheels go first, then four uprights, two bogies, two rockers, which the chassis connects, and the
// differential.
TEST(JointElimination, WheelsOfARoverComeBeforeItsRockers)
{
    const std::vector<std::int32_t> counts{5, 5, 1, 5, 5, 6, 6, 6, 6, 6, 6, 6, 6, 6, 6};
    const dem::Elimination          plan = dem::plan_elimination(rocker_bogie(), counts);
    EXPECT_EQ(plan.row_count, 81);
    EXPECT_EQ(plan.levels.first, (std::vector<std::int32_t>{0, 6, 10, 12, 13, 14, 15}));
    EXPECT_EQ(plan.first_row[9], 0);
    EXPECT_EQ(plan.first_row[2], 80);
}

TEST(JointElimination, JointsOfALevelDoNotMeet)
{
    const std::vector<std::int32_t> counts(15, 5);
    const dem::Elimination          plan = dem::plan_elimination(rocker_bogie(), counts);
    std::vector<int>                level_of(15, -1);
    for (std::size_t level = 0; level + 1 < plan.levels.first.size(); ++level)
    {
        for (auto at = plan.levels.first[level]; at < plan.levels.first[level + 1]; ++at)
        {
            level_of[static_cast<std::size_t>(plan.levels.item[static_cast<std::size_t>(at)])] =
                static_cast<int>(level);
        }
    }
    EXPECT_GE(*std::min_element(level_of.begin(), level_of.end()), 0);
    for (std::size_t j = 0; j < 15; ++j)
    {
        for (auto b = plan.below.first[j]; b < plan.below.first[j + 1]; ++b)
        {
            const auto row   = plan.below.item[static_cast<std::size_t>(b)];
            const auto other = std::find_if(plan.first_row.begin(), plan.first_row.end(),
                                            [&](std::int32_t first) { return row >= first && row < first + 5; });
            EXPECT_GT(level_of[static_cast<std::size_t>(other - plan.first_row.begin())], level_of[j]);
        }
    }
}

// What a level changes: for each of its joints the rows below and the right-hand side, once.
TEST(JointElimination, TargetsOfALevelAreTheRowsBelowItsJoints)
{
    const dem::Elimination plan = dem::plan_elimination(rocker_bogie(), std::vector<std::int32_t>(15, 5));
    std::multiset<std::pair<std::int32_t, std::int32_t>> expected, found; // joint, row
    for (std::int32_t j = 0; j < 15; ++j)
    {
        for (const std::int32_t row : items_of(plan.below, j)) { expected.emplace(j, row); }
        expected.emplace(j, plan.row_count);
    }
    for (std::int32_t level = 0; level + 1 < static_cast<std::int32_t>(plan.levels.first.size()); ++level)
    {
        const std::vector<std::int32_t> joints = items_of(plan.levels, level);
        for (auto t = plan.targets.first[static_cast<std::size_t>(level)];
             t < plan.targets.first[static_cast<std::size_t>(level) + 1]; ++t)
        {
            for (const std::int32_t j : items_of(plan.changed_by, t))
            {
                EXPECT_NE(std::find(joints.begin(), joints.end(), j), joints.end());
                found.emplace(j, plan.targets.item[static_cast<std::size_t>(t)]);
            }
        }
    }
    EXPECT_EQ(found, expected);
}

} // namespace
} // namespace tread::test
