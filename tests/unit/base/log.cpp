#include "base/log.hpp"

#include <gtest/gtest.h>

#include "mpi_session.hpp"
#include "temporary_directory.hpp"

namespace tread
{
namespace
{

using test::world;

TEST(Log, keeps_what_was_said_before_the_file_existed)
{
    const test::TemporaryDirectory directory;
    Log                            log(world(), Terminal::silent);
    log.info("first");
    log.warning("second");
    log.open(directory.path("log.txt"));
    log.info("third");
    EXPECT_EQ(test::read_text(directory.path("log.txt")), "first\nwarning: second\nthird\n");
}

TEST(Log, silent_terminal_stays_silent)
{
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    Log silent(world(), Terminal::silent);
    silent.info("a");
    silent.warning("b");
    EXPECT_EQ(::testing::internal::GetCapturedStdout() + ::testing::internal::GetCapturedStderr(), "");
}

TEST(Log, warnings_go_to_standard_error)
{
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    Log log(world(), Terminal::shown);
    log.info("a");
    log.warning("b");
    EXPECT_EQ(::testing::internal::GetCapturedStdout(), "a\n");
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "warning: b\n");
}

TEST(Log, unwritable_file_is_an_environment_error)
{
    Log log(world(), Terminal::silent);
    log.info("a");
    EXPECT_THROW(log.open("/proc/nowhere/log.txt"), EnvironmentError);
}

} // namespace
} // namespace tread
