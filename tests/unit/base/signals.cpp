#include "base/signals.hpp"

#include <csignal>

#include <gtest/gtest.h>

namespace tread
{
namespace
{

TEST(SignalWatch, NotesWhatIsAskedAndKeepsAStop)
{
    const SignalWatch watch;
    EXPECT_EQ(SignalWatch::take(), Request::none);
    std::raise(SIGUSR1);
    EXPECT_STREQ(SignalWatch::last_name(), "USR1");
    EXPECT_EQ(SignalWatch::take(), Request::checkpoint);
    EXPECT_EQ(SignalWatch::take(), Request::none);
    std::raise(SIGUSR2);
    std::raise(SIGUSR1);
    EXPECT_EQ(SignalWatch::take(), Request::stop);
    EXPECT_EQ(SignalWatch::take(), Request::stop);
}

TEST(SignalWatch, BeginsWithoutAnyAndTermAndIntStop)
{
    for (const int number : {SIGTERM, SIGINT})
    {
        const SignalWatch watch;
        EXPECT_EQ(SignalWatch::take(), Request::none);
        std::raise(number);
        EXPECT_EQ(SignalWatch::take(), Request::stop);
    }
}

TEST(SignalWatchDeathTest, ASecondIntEndsTheProcess)
{
    EXPECT_EXIT(
        {
            const SignalWatch watch;
            std::raise(SIGINT);
            std::raise(SIGINT);
        },
        ::testing::KilledBySignal(SIGINT), "");
}

} // namespace
} // namespace tread
