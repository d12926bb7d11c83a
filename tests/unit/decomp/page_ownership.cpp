#include "decomp/page_ownership.hpp"

#include <gtest/gtest.h>

#include "decomp/messages.hpp"
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

/// Pages (0, 0, 0) to (7, 0, 0), owned by ranks 0, 0, 1, 1, 2, 2, 3, 3.
PageOwnership row_of_pages()
{
    std::vector<std::uint64_t> keys;
    PageRanks                  ranks;
    for (std::int32_t x = 0; x < 8; ++x)
    {
        keys.push_back(mpm::page_key({x, 0, 0}));
        ranks.push_back(x / 2);
    }
    return {lattice, keys, ranks};
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
    EXPECT_EQ(ownership.owners_near(middle(0, 0, 0), 0.1), (Ranks{0}));
    EXPECT_EQ(ownership.owners_near(middle(1, 0, 0), 0.19), (Ranks{0}));
    EXPECT_EQ(ownership.owners_near(middle(1, 0, 0), 0.21), (Ranks{0, 1}));
    EXPECT_EQ(ownership.owners_near(middle(3, 0, 0), 0.61), (Ranks{0, 1, 2}));
    EXPECT_EQ(ownership.owners_near(middle(3, 0, 0), 1e6), (Ranks{0, 1, 2, 3}));
}

TEST(PageOwnership, KnowsWhereAllAroundAPageIsOneRanks)
{
    PageOwnership ownership = row_of_pages();
    EXPECT_TRUE(ownership.is_within(mpm::surroundings(lattice, middle(0, 0, 0), 0.1), 0));
    EXPECT_FALSE(ownership.is_within(mpm::surroundings(lattice, middle(0, 0, 0), 0.1), 1));
    EXPECT_FALSE(ownership.is_within(mpm::surroundings(lattice, middle(1, 0, 0), 0.19), 0))
        << "another place in the page";
    EXPECT_FALSE(ownership.is_within(mpm::surroundings(lattice, middle(0, 0, 0), 1e6), 0))
        << "too many pages to look at";
    EXPECT_EQ(mpm::surroundings(lattice, middle(1, 0, 0), 0.19), mpm::surroundings(lattice, middle(1, 0, 0), 0.3));
    EXPECT_NE(mpm::surroundings(lattice, middle(1, 0, 0), 0.1), Surroundings{});
}

TEST(PageOwnership, ABallThatPassesACornerDoesNotReachThePageBehindIt)
{
    // Four pages in x and y, each owned by its own rank.
    PageOwnership ownership(
        lattice,
        {mpm::page_key({0, 0, 0}), mpm::page_key({1, 0, 0}), mpm::page_key({0, 1, 0}), mpm::page_key({1, 1, 0})},
        {0, 1, 2, 3});
    const Vec3<double> at = middle(0, 0, 0) + Vec3<double>(0.1, 0.1, 0); // 0.1 from two borders, 0.141 from the corner
    EXPECT_EQ(ownership.owners_near(at, 0.12), (std::vector<std::int32_t>{0, 1, 2}));
    EXPECT_EQ(ownership.owners_near(at, 0.15), (std::vector<std::int32_t>{0, 1, 2, 3}));
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
