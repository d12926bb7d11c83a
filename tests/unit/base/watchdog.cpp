#include "base/watchdog.hpp"

#include <atomic>
#include <future>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace
{

using namespace tread;
using std::chrono::milliseconds;
using ::testing::HasSubstr;

/// First bark of a watchdog with a timeout of 20 ms.
class Barking
{
public:
    explicit Barking(const WaitNote& waits)
        : dog(waits, milliseconds(20),
              [this](const std::string& text)
              {
                  ++barks;
                  said.set_value(text);
              })
    {
    }

    std::string text() { return said.get_future().get(); }

    std::promise<std::string> said;
    std::atomic<int>          barks{0};
    Watchdog                  dog;
};

TEST(Watchdog, NamesTheRanksThatAreWaitedFor)
{
    WaitNote      waits;
    const Waiting wait(waits, "halo messages", {1, 3});
    EXPECT_THAT(Barking(waits).text(), HasSubstr("s for ranks 1, 3 (halo messages), after 0 steps"));
}

TEST(Watchdog, SaysThatAllAreWaitedFor)
{
    WaitNote      waits;
    const Waiting wait(waits, "sum");
    EXPECT_THAT(Barking(waits).text(), HasSubstr("for all ranks (sum)"));
}

TEST(Watchdog, SaysWhoHasNotComeToACollectiveCall)
{
    WaitNote                  waits;
    std::atomic<std::int64_t> count{0};
    waits.count_collectives(&count);
    const Waiting             wait(waits, "sum");
    std::promise<std::string> said;
    const Watchdog            dog(
                   waits, milliseconds(20), [&](const std::string& text) { said.set_value(text); },
                   [&] { return "to which rank 2 has not come, call " + std::to_string(count); });
    EXPECT_THAT(said.get_future().get(),
                HasSubstr("for all ranks (sum), to which rank 2 has not come, call 1, after 0"));
    const Waiting other(waits, "halo messages", {1});
    EXPECT_EQ(count, 1);
}

TEST(Watchdog, BarksOnceWhenNoStepFollows)
{
    WaitNote waits;
    Barking  barking(waits);
    barking.dog.advance();
    EXPECT_THAT(barking.text(), ::testing::AllOf(HasSubstr("has ended no step for"), HasSubstr("after 1 steps"),
                                                 HasSubstr("waits for no message")));
    std::this_thread::sleep_for(milliseconds(50));
    EXPECT_EQ(barking.barks, 1);
}

TEST(Watchdog, BarksWhenTheFirstStepDoesNotEnd)
{
    WaitNote waits;
    Barking  barking(waits);
    barking.dog.begin_steps();
    EXPECT_THAT(barking.text(), HasSubstr("after 0 steps"));
}

TEST(Watchdog, IsQuietWhereNobodyWaitsAndNoStepIsDue)
{
    WaitNote waits;
    Barking  barking(waits);
    {
        const Waiting wait(waits, "sum");
    }
    barking.dog.advance();
    barking.dog.end_steps();
    std::this_thread::sleep_for(milliseconds(100));
    EXPECT_EQ(barking.barks, 0);
}

} // namespace
