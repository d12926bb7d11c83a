#include <numeric>

#include <gtest/gtest.h>

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
    for (std::int32_t body = test::world().rank(); body < bodies; body += test::world().size()) { owned.push_back(body); }
    return owned;
}

TEST(BodyBlocks, RowsComeInTheOrderOfBodies)
{
    constexpr std::int32_t          bodies = 11;
    const std::vector<std::int32_t> owned  = dealt(bodies);
    std::vector<double>             values(bodies, -1); // of bodies of others
    for (const std::int32_t body : owned) { values[static_cast<std::size_t>(body)] = body; }

    const solver::BodyBlocks  blocks(test::world(), owned, bodies);
    const std::vector<double> block = blocks.rows(values);
    std::vector<double>       all(bodies);
    std::iota(all.begin(), all.end(), 0.0);
    EXPECT_EQ(test::world().gather(block), all);
    EXPECT_LE(test::world().maximum(static_cast<std::int64_t>(block.size())), bodies / test::world().size() + 1);
}

TEST(BodyBlocks, FewerBodiesThanRanks)
{
    const std::vector<std::int32_t> owned = dealt(1);
    const solver::BodyBlocks        blocks(test::world(), owned, 1);
    EXPECT_EQ(test::world().gather(blocks.rows(std::vector<double>{owned.empty() ? -1.0 : 5.0})),
              std::vector<double>{5.0});
}

TEST(BodyBlocks, OneRankHoldsAllAsTheyAre)
{
    const std::vector<double> values{3, 1, 2};
    EXPECT_EQ(solver::BodyBlocks().rows(values), values);
}

} // namespace
} // namespace tread
