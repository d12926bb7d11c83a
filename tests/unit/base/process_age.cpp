#include "base/process_age.hpp"

#include <chrono>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tread
{
namespace
{

using Clock = std::chrono::steady_clock;

constexpr double tick = 0.02; // s; the kernel counts in hundredths

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

const Clock::time_point loaded = Clock::now();

TEST(ProcessAge, CountsFromBeforeTheProgramWasLoaded)
{
    const double since_loaded = seconds_since(loaded);
    EXPECT_GE(process_age() + tick, since_loaded);
}

/// A child is younger than the moment before it was forked, however long that takes on a busy machine.
TEST(ProcessAge, OfAChildIsItsOwn)
{
    const Clock::time_point before = Clock::now();
    const pid_t             child  = fork();
    if (child == 0)
    {
        const double age = process_age();
        _exit(age <= seconds_since(before) + tick ? 0 : 1);
    }
    int status = -1;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

} // namespace
} // namespace tread
