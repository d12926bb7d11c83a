#include "base/watchdog.hpp"

#include <atomic>

#include <gtest/gtest.h>

namespace
{

using namespace tread;
using std::chrono::milliseconds;

TEST(Watchdog, BarksOnceWhenNothingGoesOn)
{
    std::atomic<int> barks{0};
    Watchdog         dog(milliseconds(10), [&] { ++barks; });
    while (barks == 0) { std::this_thread::sleep_for(milliseconds(1)); }
    std::this_thread::sleep_for(milliseconds(50));
    EXPECT_EQ(barks, 1);
}

TEST(Watchdog, IsQuietWhileThereIsProgressAndAtTheEnd)
{
    std::atomic<int> barks{0};
    {
        Watchdog dog(std::chrono::hours(1), [&] { ++barks; });
        dog.advance();
    }
    EXPECT_EQ(barks, 0);
}

} // namespace
