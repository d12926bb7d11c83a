#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "kernels/dem/pairs/pairs.hpp"
#include "mpi_session.hpp"
#include "solver/ranks/body_blocks.hpp"

namespace tread
{
namespace
{

/// Bodies that this rank owns when their owners follow each other as cards are dealt.
std::vector<std::int32_t> dealt(std::int32_t bodies)
{
    std::vector<std::int32_t> owned;
    for (std::int32_t body = test::world().rank(); body < bodies; body += test::world().size())
    {
        owned.push_back(body);
    }
    return owned;
}

TEST(BodyBlocks, RowsComeInTheOrderOfBodies)
{
    constexpr std::int32_t          bodies  = 11;
    const std::vector<std::int32_t> owned   = dealt(bodies);
    std::vector<std::int32_t>       numbers = owned; // and two bodies of other ranks
    for (const std::int32_t body : {0, 7}) { numbers.push_back(body); }
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    std::vector<double> values;
    for (const std::int32_t body : numbers)
    {
        values.push_back(std::binary_search(owned.begin(), owned.end(), body) ? body : -1);
    }
    const solver::BodyBlocks  blocks(test::world(), owned, solver::BodyNumbers(numbers, bodies));
    const std::vector<double> block = blocks.rows(values);
    std::vector<double>       all(bodies);
    std::iota(all.begin(), all.end(), 0.0);
    EXPECT_EQ(test::world().gather(block), all);
    EXPECT_LE(test::world().maximum(static_cast<std::int64_t>(block.size())), bodies / test::world().size() + 1);
}

TEST(BodyBlocks, FewerBodiesThanRanks)
{
    const std::vector<std::int32_t> owned = dealt(1);
    const solver::BodyBlocks        blocks(test::world(), owned, solver::BodyNumbers(1));
    EXPECT_EQ(test::world().gather(blocks.rows(std::vector<double>{owned.empty() ? -1.0 : 5.0})),
              std::vector<double>{5.0});
}

TEST(BodyBlocks, OneRankHoldsAllAsTheyAre)
{
    const std::vector<double> values{3, 1, 2};
    EXPECT_EQ(solver::BodyBlocks().rows(values), values);
}

TEST(BodyNumbers, KeysOfTheSceneAndOfRows)
{
    const solver::BodyNumbers numbers({0, 3, 4, 9}, 12);
    EXPECT_EQ(numbers.rows(), 4U);
    EXPECT_EQ(numbers.find_row(4), 2);
    EXPECT_EQ(numbers.find_row(5), std::nullopt);
    EXPECT_EQ(numbers.key_in_scene(dem::pair_key(1, 3) + 2), dem::pair_key(3, 9) + 2);
    EXPECT_EQ(numbers.key_in_scene(dem::pair_key(1, 5)), dem::pair_key(3, 13)) << "the second wall";
    EXPECT_EQ(numbers.find_key(dem::pair_key(3, 9) + 2), dem::pair_key(1, 3) + 2);
    EXPECT_EQ(numbers.find_key(dem::pair_key(3, 13)), dem::pair_key(1, 5));
    EXPECT_EQ(numbers.find_key(dem::pair_key(3, 5)), std::nullopt);
    EXPECT_EQ(numbers.of_rows(std::vector<int>{0, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100, 110}),
              (std::vector<int>{0, 30, 40, 90}));
}

TEST(BodyNumbers, ChangesOfRows)
{
    const auto change = solver::change_between({0, 3, 4, 9}, {0, 2, 4, 9, 11});
    ASSERT_TRUE(change.has_value());
    EXPECT_EQ(change->from, (std::vector<std::int32_t>{0, -1, 2, 3, -1}));
    EXPECT_EQ(change->to, (std::vector<std::int32_t>{0, -1, 2, 3}));
    EXPECT_FALSE(solver::change_between({0, 3}, {0, 3}).has_value());
}

} // namespace
} // namespace tread
