#include "decomp/halo_plan.hpp"

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "kernels/mpm/pages/page_key.hpp"
#include "mpi_session.hpp"

// Exchange plans of shared node pages.
namespace tread::decomp
{
namespace
{

const IsHeld no_walls = [](std::uint64_t) { return false; };

PageKeys keys_of(std::vector<mpm::Index3> pages)
{
    PageKeys keys;
    for (const mpm::Index3& page : pages) { keys.push_back(mpm::page_key(page)); }
    std::sort(keys.begin(), keys.end());
    return keys;
}

PageKeys row(int first, int last)
{
    std::vector<mpm::Index3> pages;
    for (int x = first; x <= last; ++x) { pages.push_back({x, 3, 3}); }
    return keys_of(pages);
}

TEST(HaloPlan, TwoRanksInARowShareWhatBothReach)
{
    const std::vector<PageKeys> reached{row(0, 5), row(4, 9)};
    const HaloPlan              low = plan_halo(0, reached, no_walls), high = plan_halo(1, reached, no_walls);
    for (const HaloPlan* plan : {&low, &high})
    {
        EXPECT_EQ(plan->shared, row(4, 5));
        EXPECT_TRUE(plan->extra.empty());
        EXPECT_EQ(plan->first_part, (std::vector<std::int32_t>{0, 2, 4}));
    }
    EXPECT_EQ(low.send[1], (std::vector<std::int32_t>{0, 1}));
    EXPECT_EQ(low.arrivals, (std::vector<std::int64_t>{0, 2}));
    EXPECT_EQ(low.part, (std::vector<std::int32_t>{-1, 0, -1, 1})); // rank 0's contribution first, on both
    EXPECT_EQ(high.part, (std::vector<std::int32_t>{0, -1, 1, -1}));
    EXPECT_TRUE(low.tallied_elsewhere.empty());
    EXPECT_EQ(high.tallied_elsewhere, (std::vector<std::int32_t>{0, 1}));
}

TEST(HaloPlan, RanksThatAreFarFromEachOtherShareNothing)
{
    const HaloPlan plan = plan_halo(0, {row(0, 3), row(5, 9)}, no_walls);
    EXPECT_TRUE(plan.shared.empty());
    EXPECT_TRUE(plan.part.empty());
}

/// The wall ties the nodes of page 4 to those of page 3, which rank 1 does not reach.
TEST(HaloPlan, AWallBringsThePageBesideIt)
{
    const IsHeld                held = [](std::uint64_t page) { return mpm::page_coordinates(page).x <= 4; };
    const std::vector<PageKeys> reached{row(0, 3), row(4, 9)};
    const HaloPlan              low = plan_halo(0, reached, held), high = plan_halo(1, reached, held);
    EXPECT_EQ(high.extra, row(3, 3));
    EXPECT_EQ(low.extra, row(4, 4));
    EXPECT_EQ(high.shared, row(3, 4));
    EXPECT_EQ(high.part, (std::vector<std::int32_t>{0, -1}));
    EXPECT_EQ(high.tallied_elsewhere, (std::vector<std::int32_t>{0}));
    EXPECT_EQ(low.tallied_elsewhere, (std::vector<std::int32_t>{1}));
}

std::vector<PageKeys> random_pages(int ranks, unsigned seed)
{
    std::mt19937          random(seed);
    std::vector<PageKeys> all;
    for (int rank = 0; rank < ranks; ++rank)
    {
        std::set<std::uint64_t> keys;
        for (int i = 0; i < 60; ++i)
        {
            const auto at = [&] { return static_cast<std::int32_t>(random() % 6) - 2; };
            keys.insert(mpm::page_key({at(), at(), at()}));
        }
        all.emplace_back(keys.begin(), keys.end());
    }
    return all;
}

/// Guarantees of plan_halo, on random page sets: each rank adds every contribution to every page that it has or needs,
/// in rank order, and one rank accounts for it.
TEST(HaloPlan, OfRandomPagesBringsEveryPartToWhoNeedsIt)
{
    constexpr int ranks = 4;
    const IsHeld  held  = [](std::uint64_t page) { return mpm::page_coordinates(page).z <= 0; };
    for (unsigned seed = 0; seed < 20; ++seed)
    {
        const std::vector<PageKeys>  reached = random_pages(ranks, seed);
        std::vector<HaloPlan>        plans;
        std::map<std::uint64_t, int> counted;
        for (int rank = 0; rank < ranks; ++rank) { plans.push_back(plan_halo(rank, reached, held)); }
        for (std::size_t rank = 0; rank < ranks; ++rank)
        {
            const HaloPlan&             plan = plans[rank];
            const std::set<std::size_t> elsewhere(plan.tallied_elsewhere.begin(), plan.tallied_elsewhere.end());
            // Arrivals: the pages that each rank sends, rank after rank.
            std::vector<std::pair<std::uint64_t, std::size_t>> arrived;
            for (std::size_t other = 0; other < ranks; ++other)
            {
                const auto& send = plans[other].send[rank];
                EXPECT_EQ(static_cast<std::int64_t>(send.size()), plan.arrivals[other]);
                for (const std::int32_t number : send)
                {
                    arrived.emplace_back(plans[other].shared[static_cast<std::size_t>(number)], other);
                }
            }
            for (std::size_t number = 0; number < plan.shared.size(); ++number)
            {
                const std::uint64_t      page = plan.shared[number];
                std::vector<std::size_t> expected, found;
                for (std::size_t other = 0; other < ranks; ++other)
                {
                    if (std::binary_search(reached[other].begin(), reached[other].end(), page))
                    {
                        expected.push_back(other);
                    }
                }
                for (auto p = plan.first_part[number]; p < plan.first_part[number + 1]; ++p)
                {
                    const std::int32_t part = plan.part[static_cast<std::size_t>(p)];
                    if (part >= 0) { EXPECT_EQ(arrived[static_cast<std::size_t>(part)].first, page); }
                    found.push_back(part < 0 ? rank : arrived[static_cast<std::size_t>(part)].second);
                }
                EXPECT_EQ(found, expected);
            }
            for (const std::uint64_t page : reached[rank])
            {
                const auto at     = std::lower_bound(plan.shared.begin(), plan.shared.end(), page);
                const bool shared = at != plan.shared.end() && *at == page;
                if (!shared || elsewhere.count(static_cast<std::size_t>(at - plan.shared.begin())) == 0)
                {
                    ++counted[page];
                }
            }
        }
        for (const auto& [page, times] : counted) { EXPECT_EQ(times, 1); }
    }
}

/// A rank knows as many pages of the others as its plan needs.
TEST(HaloPlan, IsTheSameFromThePagesNearby)
{
    const auto&                 world   = test::world();
    const IsHeld                held    = [](std::uint64_t page) { return mpm::page_coordinates(page).z <= 0; };
    const std::vector<PageKeys> reached = random_pages(world.size(), 77);
    const auto                  rank    = static_cast<std::size_t>(world.rank());
    const std::vector<PageKeys> near    = pages_nearby(world, reached[rank]);
    const HaloPlan              plan    = plan_halo(world.rank(), near, held);
    const HaloPlan              wanted  = plan_halo(world.rank(), reached, held);
    EXPECT_EQ(plan.shared, wanted.shared);
    EXPECT_EQ(plan.send, wanted.send);
    EXPECT_EQ(plan.part, wanted.part);
    EXPECT_EQ(plan.extra, wanted.extra);
    EXPECT_EQ(plan.tallied_elsewhere, wanted.tallied_elsewhere);
}

} // namespace
} // namespace tread::decomp
