#include "decomp/balance.hpp"

#include <gtest/gtest.h>

// When pages are dealt out anew.
namespace tread::decomp
{
namespace
{

const BalanceRule rule(1.15);

TEST(Balance, IsLargestOverMean)
{
    EXPECT_DOUBLE_EQ(imbalance_of({300, 100, 200}), 1.5);
    EXPECT_DOUBLE_EQ(imbalance_of({0, 0}), 1);
}

TEST(Balance, ASmallUnevennessIsLeftAlone)
{
    EXPECT_FALSE(rule.is_due({1.1e6, 0.9e6}, 1'000'000));
    EXPECT_TRUE(rule.is_due({1.3e6, 0.7e6}, 1'000'000));
}

TEST(Balance, NothingIsDoneWhereItWouldCostMoreThanItSaves)
{
    EXPECT_FALSE(rule.is_due({1.3e6, 0.7e6}, 10)); // a look at METIS costs as much as 30 steps
    const std::vector<double> now{1.3e6, 0.7e6}, after{1e6, 1e6};
    EXPECT_TRUE(rule.is_worth(now, after, 0.3e6, 1000));
    EXPECT_FALSE(rule.is_worth(now, after, 0.3e6, 100)); // 0.3e6 x 100 steps saved; 30 x 1e6 + 20 x 0.15e6 spent
    EXPECT_FALSE(rule.is_worth(now, now, 0, 1'000'000));
}

TEST(Balance, MuchThatMovesWantsMoreSteps)
{
    const std::vector<double> now{1.3e6, 0.7e6}, after{1e6, 1e6};
    EXPECT_TRUE(rule.is_worth(now, after, 0, 120));
    EXPECT_FALSE(rule.is_worth(now, after, 2e6, 120));
}

} // namespace
} // namespace tread::decomp
