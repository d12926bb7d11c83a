#include "decomp/page_ownership.hpp"

#include <algorithm>
#include <array>
#include <random>

#include <gtest/gtest.h>

#include "decomp/messages.hpp"
#include "decomp/page_map.hpp"
#include "kernels/mpm/pages/page_key.hpp"
#include "mpi_session.hpp"

// Ownership of positions, and messages between ranks.
namespace tread::decomp
{
namespace
{

constexpr double      width = 0.4; // m, of a page
constexpr PageLattice lattice{0.1, 0.5};

/// The middle of a page.
Vec3<double> middle(std::int32_t x, std::int32_t y, std::int32_t z)
{
    return width * (Vec3<double>(x, y, z) + Vec3<double>::Constant(0.5)) + Vec3<double>::Constant(0.05);
}

/// A reach of bodies alone, m.
mpm::Reach bodies_within(double radius) { return {radius, 0}; }

std::vector<std::int32_t> owners_near(PageOwnership& ownership, const Vec3<double>& centre, const mpm::Reach& reach)
{
    std::vector<std::int32_t> ranks{7}; // what is there before does not matter
    ownership.around(centre, reach).find_owners(ranks);
    return ranks;
}

/// Pages (0, 0, 0) to (7, 0, 0), owned by ranks 0, 0, 1, 1, 2, 2, 3, 3; sand has been in those of rank 2.
PageOwnership row_of_pages()
{
    std::vector<std::uint64_t> keys;
    PageRanks                  ranks;
    for (std::int32_t x = 0; x < 8; ++x)
    {
        keys.push_back(mpm::page_key({x, 0, 0}));
        ranks.push_back(x / 2);
    }
    return {lattice, keys, ranks, {0, 0, 0, 0, 1, 1, 0, 0}};
}

TEST(PageOwnership, BelongsToTheOwnersOfPages)
{
    PageOwnership ownership = row_of_pages();
    for (std::int32_t x = 0; x < 8; ++x)
    {
        EXPECT_EQ(ownership.owner_of(middle(x, 0, 0)), x / 2);
        EXPECT_EQ(ownership.owner_of(mpm::page_key({x, 0, 0})), x / 2);
    }
}

TEST(PageOwnership, GivesPagesThatNobodyKnowsToTheNearestOwner)
{
    PageOwnership ownership = row_of_pages();
    for (std::int32_t x = 0; x < 8; ++x)
    {
        EXPECT_EQ(ownership.owner_of(middle(x, 1, 0)), x / 2);
        EXPECT_EQ(ownership.owner_of(middle(x, 0, -2)), x / 2);
    }
    EXPECT_EQ(ownership.owner_of(middle(-2, 1, 1)), 0);
}

TEST(PageOwnership, GivesPagesFarFromAllToTheRankBeforeThem)
{
    PageOwnership ownership = row_of_pages();
    EXPECT_EQ(ownership.owner_of(middle(-3, 0, 0)), 0); // before all by key
    EXPECT_EQ(ownership.owner_of(middle(100, 100, 100)), 3);
    EXPECT_EQ(ownership.owner_of(Vec3<double>(1e300, 0, 0)), ownership.owner_of(Vec3<double>(1e301, 0, 0)));
}

TEST(PageOwnership, FindsAllRanksThatABallReaches)
{
    PageOwnership ownership = row_of_pages();
    using Ranks             = std::vector<std::int32_t>;
    EXPECT_EQ(owners_near(ownership, middle(0, 0, 0), bodies_within(0.1)), (Ranks{0}));
    EXPECT_EQ(owners_near(ownership, middle(1, 0, 0), bodies_within(0.19)), (Ranks{0}));
    EXPECT_EQ(owners_near(ownership, middle(1, 0, 0), bodies_within(0.21)), (Ranks{0, 1}));
    EXPECT_EQ(owners_near(ownership, middle(3, 0, 0), bodies_within(0.61)), (Ranks{0, 1, 2}));
    EXPECT_EQ(owners_near(ownership, middle(3, 0, 0), bodies_within(1e6)), (Ranks{0, 1, 2, 3}));
}

TEST(PageOwnership, KnowsHowFarAwayOthersAre)
{
    PageOwnership ownership = row_of_pages();
    const auto    clear     = [&](std::int32_t rank, const Vec3<double>& place, const mpm::Reach& reach)
    {
        const mpm::Reach found = ownership.around(place, reach).clear_of_others(rank);
        return std::array{found.bodies, found.sand};
    };
    const auto expect_near = [](const std::array<double, 2>& found, double bodies, double sand)
    {
        EXPECT_NEAR(found[0], bodies, 1e-12);
        EXPECT_NEAR(found[1], sand, 1e-12);
    };
    expect_near(clear(0, middle(1, 0, 0), {0.1, 0.9}), 0.2, 1.0); // the page of rank 1, and that of rank 2 with sand
    expect_near(clear(0, middle(0, 0, 0), {0.1, 0.1}), 0.4, 0.4); // it looks one page far
    expect_near(clear(0, middle(0, 0, 0), {0.5, 0.1}), 0.6, 0.8); // two, and no sand is there
    expect_near(clear(0, middle(0, 0, 0), {0.1, 0.5}), 0.6, 0.8);
    expect_near(clear(0, middle(1, 0, 0), {0.21, 0.1}), 0, 0); // the page of rank 1 is within reach
    expect_near(clear(0, middle(1, 0, 0), {0.1, 1.01}), 0, 0); // the sand of rank 2 is
    expect_near(clear(1, middle(0, 0, 0), {0.1, 0.1}), 0, 0);  // not its page
    expect_near(clear(0, middle(0, 0, 0), {0.1, 1e6}), 0, 0);  // too many pages to look at
}

TEST(PageOwnership, ABallThatPassesACornerDoesNotReachThePageBehindIt)
{
    // Four pages in x and y, each owned by its own rank.
    PageOwnership ownership(
        lattice,
        {mpm::page_key({0, 0, 0}), mpm::page_key({1, 0, 0}), mpm::page_key({0, 1, 0}), mpm::page_key({1, 1, 0})},
        {0, 1, 2, 3}, {1, 1, 1, 1});
    const Vec3<double> at = middle(0, 0, 0) + Vec3<double>(0.1, 0.1, 0); // 0.1 from two borders, 0.141 from the corner
    EXPECT_EQ(owners_near(ownership, at, bodies_within(0.12)), (std::vector<std::int32_t>{0, 1, 2}));
    EXPECT_EQ(owners_near(ownership, at, bodies_within(0.15)), (std::vector<std::int32_t>{0, 1, 2, 3}));
}

/// A page that no sand has been in has none that a body could touch.
TEST(PageOwnership, SandIsWhereItHasBeen)
{
    PageOwnership ownership = row_of_pages();
    using Ranks             = std::vector<std::int32_t>;
    EXPECT_EQ(owners_near(ownership, middle(3, 0, 0), {0.1, 0.19}), (Ranks{1})) << "a page of rank 2 is 0.2 m away";
    EXPECT_EQ(owners_near(ownership, middle(3, 0, 0), {0.1, 0.21}), (Ranks{1, 2}));
    EXPECT_EQ(owners_near(ownership, middle(3, 0, 0), {0.1, 1.5}), (Ranks{1, 2})) << "ranks 0 and 3 have no sand";
    EXPECT_EQ(owners_near(ownership, middle(0, 0, 0), {0.61, 1.41}), (Ranks{0, 1, 2}));
}

TEST(PageOwnership, ARankIsNearToItsPages)
{
    PageOwnership ownership = row_of_pages();
    const auto    has       = [&](std::int32_t rank, double radius)
    { return ownership.around(middle(1, 0, 0), bodies_within(radius)).owner_before_all(rank) == rank; };
    EXPECT_TRUE(has(0, 0));
    EXPECT_FALSE(has(1, 0.19));
    EXPECT_TRUE(has(1, 0.21));
    EXPECT_FALSE(has(2, 0.21));
}

/// Compares with a search through all pages.
TEST(PageOwnership, NothingIsMissedAmongPagesOfManyRanks)
{
    std::mt19937                                random(1);
    std::uniform_int_distribution<std::int32_t> rank(0, 4);
    std::vector<std::uint64_t>                  keys;
    for (std::int32_t x = 0; x < 6; ++x)
    {
        for (std::int32_t y = 0; y < 6; ++y) { keys.push_back(mpm::page_key({x, y, 0})); }
    }
    std::sort(keys.begin(), keys.end());
    PageRanks                 ranks;
    std::vector<std::uint8_t> sand;
    for (std::size_t i = 0; i < keys.size(); ++i)
    {
        ranks.push_back(rank(random));
        sand.push_back(rank(random) < 2 ? 1 : 0);
    }
    PageOwnership                          ownership(lattice, keys, ranks, sand);
    std::uniform_real_distribution<double> place(0.9, 1.6);
    for (int i = 0; i < 200; ++i)
    {
        const Vec3<double>        at{place(random), place(random), 0.25};
        const mpm::Reach          reach{0.05 + 0.1 * place(random), 0.3 * place(random)};
        std::vector<std::int32_t> expected{ownership.owner_of(at)};
        for (std::size_t page = 0; page < keys.size(); ++page)
        {
            const mpm::Index3  index = mpm::page_coordinates(keys[page]);
            const Vec3<double> low   = middle(index.x, index.y, index.z) - Vec3<double>::Constant(width / 2);
            const Vec3<double> near  = at.cwiseMax(low).cwiseMin(low + Vec3<double>::Constant(width));
            const double       way   = (near - at).norm();
            if (way <= reach.bodies || (sand[page] != 0 && way <= reach.sand)) { expected.push_back(ranks[page]); }
        }
        std::sort(expected.begin(), expected.end());
        expected.erase(std::unique(expected.begin(), expected.end()), expected.end());
        EXPECT_EQ(owners_near(ownership, at, reach), expected) << at.transpose();
    }
}

TEST(PageMap, KnowsWhereSandHasBeen)
{
    Counters     counters;
    PageMap<Cpu> map(Cpu{&counters});
    map.assign({2, 4, 6}, {0, 1, 2});
    EXPECT_EQ(map.view().of(4), -1) << "kernels know pages with sand";
    map.enter_sand({4});
    EXPECT_EQ(map.view().of(4), 1);
    map.enter_sand({3, 6, 9}, {0, 0, 1});
    EXPECT_EQ(map.keys(), (std::vector<std::uint64_t>{2, 3, 4, 6, 9}));
    EXPECT_EQ(map.ranks(), (PageRanks{0, 0, 1, 2, 1})) << "page 6 had an owner";
    EXPECT_EQ(map.sand(), (std::vector<std::uint8_t>{0, 1, 1, 1, 1}));
    EXPECT_EQ(map.view().of(2), -1);
    EXPECT_EQ(map.owner(2), 0);
    map.assign({1, 4, 9}, {2, 2, 2});
    EXPECT_EQ(map.sand(), (std::vector<std::uint8_t>{0, 1, 1})) << "new owners, the same sand";
    EXPECT_EQ(map.view().of(9), 2);
}

TEST(Letters, ArriveFromEveryRank)
{
    const int                        rank = test::world().rank(), ranks = test::world().size();
    std::vector<std::vector<double>> sent(static_cast<std::size_t>(ranks));
    for (int to = 0; to < ranks; ++to)
    {
        for (int i = 0; i < rank + 2 * to; ++i)
        {
            sent[static_cast<std::size_t>(to)].push_back(100 * rank + 10 * to + i);
        }
    }
    const auto found = exchange_values(test::world(), sent);
    ASSERT_EQ(found.size(), static_cast<std::size_t>(ranks));
    for (int from = 0; from < ranks; ++from)
    {
        const auto& values = found[static_cast<std::size_t>(from)];
        ASSERT_EQ(values.size(), static_cast<std::size_t>(from + 2 * rank));
        for (std::size_t i = 0; i < values.size(); ++i)
        {
            EXPECT_EQ(values[i], 100 * from + 10 * rank + static_cast<double>(i));
        }
    }
}

TEST(Letters, OfOneRankReachAll)
{
    const auto found = gather_values<std::int32_t>(test::world(), {test::world().rank()});
    for (std::size_t r = 0; r < found.size(); ++r)
    {
        EXPECT_EQ(found[r], std::vector<std::int32_t>{static_cast<int>(r)});
    }
}

} // namespace
} // namespace tread::decomp
