#include <gtest/gtest.h>

#include "solver/ranks/body_holding.hpp"

// Holdings of shared bodies, and as words of a checkpoint, which may come from anywhere.
namespace tread::solver
{
namespace
{

using Words = std::vector<std::int32_t>;

TEST(BodyHolding, WordsAreReadAsTheyWereWritten)
{
    const Words  two{0, 1}, three{1, 2, 3};
    BodyHoldings held;
    held.add({3, 1, two});
    held.add({7, 1, three});
    EXPECT_EQ(held.words(), (Words{3, 1, 2, 0, 1, 7, 1, 3, 1, 2, 3}));
    const auto read = read_holdings(held.words(), 1, 4, 10);
    ASSERT_TRUE(read.has_value());
    Words bodies, holders;
    for (const BodyHolding& body : *read)
    {
        bodies.push_back(body.body);
        EXPECT_EQ(body.owner, 1);
        holders.insert(holders.end(), body.holders.begin(), body.holders.end());
    }
    EXPECT_EQ(bodies, (Words{3, 7}));
    EXPECT_EQ(holders, (Words{0, 1, 1, 2, 3}));
    EXPECT_TRUE(read_holdings({}, 1, 4, 10)->words().empty());
}

TEST(BodyHolding, OtherWordsAreRefused)
{
    const auto refused = [](const Words& words) { return !read_holdings(words, 1, 4, 10).has_value(); };
    EXPECT_FALSE(refused({3, 1, 2, 0, 1}));
    EXPECT_TRUE(refused({3, 1})) << "cut off";
    EXPECT_TRUE(refused({3, 1, 2, 0})) << "cut off";
    EXPECT_TRUE(refused({3, 1, -1, 0, 1})) << "a negative number of holders";
    EXPECT_TRUE(refused({3, 1, 2000000000, 0, 1})) << "more holders than words";
    EXPECT_TRUE(refused({10, 1, 2, 0, 1})) << "no such body";
    EXPECT_TRUE(refused({-1, 1, 2, 0, 1})) << "no such body";
    EXPECT_TRUE(refused({3, 1, 2, 0, 1, 3, 1, 2, 0, 1})) << "twice";
    EXPECT_TRUE(refused({3, 2, 2, 1, 2})) << "another rank decides";
    EXPECT_TRUE(refused({3, 1, 1, 1})) << "held by one alone";
    EXPECT_TRUE(refused({3, 1, 2, 1, 0})) << "not ascending";
    EXPECT_TRUE(refused({3, 1, 2, 1, 1})) << "a holder twice";
    EXPECT_TRUE(refused({3, 1, 2, 1, 4})) << "no such rank";
    EXPECT_TRUE(refused({3, 1, 2, -1, 1})) << "no such rank";
    EXPECT_TRUE(refused({3, 1, 2, 0, 2})) << "not its owner";
}

TEST(BodyHolding, ChangesAreTaken)
{
    const Words  two{0, 1}, three{0, 1, 2}, mine{1}, others{0, 2};
    BodyHoldings held, changes;
    held.add({3, 1, two});
    held.add({5, 0, two});
    held.add({7, 1, two});
    changes.add({2, 0, three});  // comes
    changes.add({3, 1, mine});   // is this rank's alone
    changes.add({7, 1, three});  // a third rank holds it
    changes.add({9, 0, others}); // never was this rank's
    EXPECT_EQ(changed(held, changes, 1).words(), (Words{2, 0, 3, 0, 1, 2, 5, 0, 2, 0, 1, 7, 1, 3, 0, 1, 2}));
    EXPECT_EQ(changed(held, {}, 1).words(), held.words());
    EXPECT_TRUE(changed({}, {}, 1).empty());
}

TEST(BodyHolding, WhatIsNotListedIsOnesOwn)
{
    const Words  two{0, 1};
    BodyHoldings held;
    held.add({3, 1, two});
    held.add({7, 1, two});
    HoldingLookup look(held, 2);
    EXPECT_FALSE(look.lists(1));
    const BodyHolding alone = look.of(2);
    EXPECT_EQ(alone.owner, 2);
    EXPECT_EQ(Words(alone.holders.begin(), alone.holders.end()), Words{2});
    EXPECT_TRUE(look.lists(3));
    EXPECT_EQ(look.of(3).owner, 1);
    EXPECT_TRUE(look.lists(7));
    EXPECT_FALSE(look.lists(8));
}

} // namespace
} // namespace tread::solver
