#include <algorithm>
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

// All six wheels go first, six rows each; then four uprights, six; two bogies, five; two rockers, which the chassis
// connects, five each; and the differential, one.
TEST(JointElimination, RoverTakesAsManyStepsAsItsLongestArm)
{
    const std::vector<std::int32_t> counts{5, 5, 1, 5, 5, 6, 6, 6, 6, 6, 6, 6, 6, 6, 6};
    const dem::Elimination          plan = dem::plan_elimination(rocker_bogie(), counts);
    EXPECT_EQ(plan.row_count, 81);
    EXPECT_EQ(plan.pivots.first.size() - 1, 6u + 6u + 5u + 5u + 5u + 1u);
    EXPECT_EQ(plan.pivots.first[1], 6);
}

TEST(JointElimination, EachRowIsEliminatedOnceAfterAllBeforeIt)
{
    const std::vector<std::int32_t> counts(15, 5);
    const dem::Elimination          plan = dem::plan_elimination(rocker_bogie(), counts);
    std::vector<int>                step_of(static_cast<std::size_t>(plan.row_count), -1);
    for (std::size_t step = 0; step + 1 < plan.pivots.first.size(); ++step)
    {
        for (auto p = plan.pivots.first[step]; p < plan.pivots.first[step + 1]; ++p)
        {
            int& of = step_of[static_cast<std::size_t>(plan.pivots.item[static_cast<std::size_t>(p)])];
            EXPECT_EQ(of, -1);
            of = static_cast<int>(step);
        }
    }
    EXPECT_GE(*std::min_element(step_of.begin(), step_of.end()), 0);
    for (std::size_t row = 0; row < step_of.size(); ++row)
    {
        for (auto b = plan.before.first[row]; b < plan.before.first[row + 1]; ++b)
        {
            const auto column = static_cast<std::size_t>(plan.before.item[static_cast<std::size_t>(b)]);
            EXPECT_LT(column, row);
            EXPECT_LT(step_of[column], step_of[row]);
        }
    }
}

} // namespace
} // namespace tread::test
