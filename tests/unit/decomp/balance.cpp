#include "decomp/balance.hpp"

#include <gtest/gtest.h>

#include "backend/counters.hpp"
#include "kernels/mpm/pages/page_key.hpp"
#include "mpi_session.hpp"

// Decisions to repartition.
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
    EXPECT_FALSE(rule.is_due({1.3e6, 0.7e6}, 10)); // running METIS costs as much as 30 steps
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

/// Where a little is awake, a GPU's launches take longer than its points, and ranks are left as they are.
TEST(Balance, LittleLoadIsNotDivided)
{
    const BalanceRule      of_gpu(1.15, 5e5);
    constexpr std::int64_t steps = 1'000'000;
    EXPECT_TRUE(rule.is_due({3.8e5, 1e3}, steps));
    EXPECT_FALSE(of_gpu.is_due({3.8e5, 1e3}, steps));
    EXPECT_FALSE(of_gpu.is_due({5.2e5, 1e3}, steps)) << "1.02 times the mean of what is felt";
    EXPECT_TRUE(of_gpu.is_due({2e6, 1e3}, steps));
    EXPECT_TRUE(of_gpu.is_worth({2e6, 1e3}, {1e6, 1e6}, 1e6, steps));
    EXPECT_FALSE(of_gpu.is_worth({4.5e5, 0}, {2.25e5, 2.25e5}, 0, steps));
}

/// A row of 32 pages of 100 points owned by rank 0, except the last, of which all ranks have an equal share.
PageLoads mostly_of_the_first()
{
    PageLoads loads;
    const int last = 31;
    for (std::int32_t x = 0; x < last && test::world().rank() == 0; ++x) { loads[mpm::page_key({x, 0, 0})] = 100; }
    loads[mpm::page_key({last, 0, 0})] = 100.0 / test::world().size();
    return loads;
}

double sum_of(const PageLoads& loads)
{
    double sum = 0;
    for (const auto& [page, load] : loads) { sum += load; }
    return sum;
}

TEST(Balance, DealsOutWhatOneRankHasTooMuchOf)
{
    const int          ranks = test::world().size();
    Counters           counters;
    Decomposition<Cpu> decomposition(test::world(), Cpu{&counters}, {});
    Balance<Cpu>       balance(decomposition, rule);
    const PageLoads    own = mostly_of_the_first();
    EXPECT_FALSE(balance.is_due(1'000'000)) << "nothing is known yet";
    balance.note(sum_of(own), 0);
    EXPECT_NEAR(balance.row().imbalance, (31.0 + 1.0 / ranks) * ranks / 32, 1e-12);
    EXPECT_FALSE(balance.is_due(10));
    EXPECT_EQ(balance.is_due(1000), ranks > 1);
    if (ranks == 1) { return; }

    ASSERT_TRUE(balance.repartition(own, 1000));
    EXPECT_EQ(balance.row().repartitions, 1);
    EXPECT_FALSE(balance.is_due(1010)) << "that was just done";
    std::vector<double> loads(static_cast<std::size_t>(ranks), 0.0);
    EXPECT_EQ(decomposition.owners.keys().size(), 32U) << "the page that all ranks have counts once";
    for (const std::int32_t owner : decomposition.owners.ranks()) { loads[static_cast<std::size_t>(owner)] += 100; }
    EXPECT_LT(imbalance_of(loads), 1.15);
}

TEST(Balance, AnewIsNotAskedWhetherItPays)
{
    const int          ranks = test::world().size();
    Counters           counters;
    Decomposition<Cpu> decomposition(test::world(), Cpu{&counters}, {});
    Balance<Cpu>       balance(decomposition, rule);
    const PageLoads    own = mostly_of_the_first();
    balance.note(sum_of(own), 0);
    ASSERT_FALSE(balance.repartition(own, 0)) << "no step has shown that it would";
    balance.repartition_anew(own, 0);
    EXPECT_EQ(balance.row().repartitions, 1);
    std::vector<double> loads(static_cast<std::size_t>(ranks), 0.0);
    for (const std::int32_t owner : decomposition.owners.ranks()) { loads[static_cast<std::size_t>(owner)] += 100; }
    EXPECT_LT(imbalance_of(loads), 1.15);
}

TEST(Balance, AnewLeavesPagesWithoutLoadAsTheyAre)
{
    Counters           counters;
    Decomposition<Cpu> decomposition(test::world(), Cpu{&counters}, {});
    decomposition.owners.assign({1, 2}, {0, 0});
    Balance<Cpu> balance(decomposition, rule);
    balance.repartition_anew({}, 0);
    EXPECT_EQ(decomposition.owners.keys().size(), 2U);
    EXPECT_EQ(balance.row().repartitions, 0);
}

TEST(Balance, WaitsTwiceAsLongWhereItWasNotWorthIt)
{
    if (test::world().size() == 1) { GTEST_SKIP() << "one rank"; }
    Counters           counters;
    Decomposition<Cpu> decomposition(test::world(), Cpu{&counters}, {});
    Balance<Cpu>       balance(decomposition, rule);
    PageLoads          own; // one page, which cannot be divided
    if (test::world().rank() == 0) { own[mpm::page_key({0, 0, 0})] = 3200; }
    balance.note(sum_of(own), 0);
    ASSERT_TRUE(balance.is_due(1000));
    EXPECT_FALSE(balance.repartition(own, 1000));
    EXPECT_FALSE(balance.is_due(1999));
    EXPECT_TRUE(balance.is_due(2000));
    EXPECT_EQ(balance.row().repartitions, 0);
}

} // namespace
} // namespace tread::decomp
