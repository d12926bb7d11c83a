#include "base/log.hpp"

#include <filesystem>

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

TEST(Log, a_status_stands_below_all_lines_and_in_no_file)
{
    const test::TemporaryDirectory directory;
    ::testing::internal::CaptureStdout();
    {
        Log log(world(), Terminal::live);
        log.open(directory.path("log.txt"));
        log.info("a");
        log.status("half");
        log.progress("1 of 2");
        log.status("whole\x1b");
        log.info("b");
        log.status("end");
    }
    const std::string erase = "\r\x1b[K";
    EXPECT_EQ(::testing::internal::GetCapturedStdout(), "a\nhalf" + erase + "whole\\x1b" + erase + "b\nend" + erase);
    EXPECT_EQ(test::read_text(directory.path("log.txt")), "a\n1 of 2\nb\n");
}

TEST(Log, a_terminal_that_cannot_redraw_gets_lines)
{
    ::testing::internal::CaptureStdout();
    {
        Log log(world(), Terminal::shown);
        log.status("half");
        log.progress("1 of 2");
    }
    EXPECT_EQ(::testing::internal::GetCapturedStdout(), "1 of 2\n");
}

TEST(Log, unwritable_file_is_an_environment_error)
{
    Log log(world(), Terminal::silent);
    log.info("a");
    EXPECT_THROW(log.open("/proc/nowhere/log.txt"), EnvironmentError);
}

TEST(Log, follows_no_link)
{
    const test::TemporaryDirectory directory;
    std::ofstream(directory.path("outside")) << "mine";
    std::filesystem::create_symlink(directory.path("outside"), directory.path("log.txt"));
    for (const LogFile file : {LogFile::anew, LogFile::continued})
    {
        Log log(world(), Terminal::silent);
        log.info("a");
        EXPECT_THROW(log.open(directory.path("log.txt"), file), EnvironmentError);
    }
    EXPECT_EQ(test::read_text(directory.path("outside")), "mine");
}

TEST(Log, goes_on_at_the_end_of_a_file)
{
    const test::TemporaryDirectory directory;
    for (const LogFile file : {LogFile::anew, LogFile::continued})
    {
        Log log(world(), Terminal::silent);
        log.open(directory.path("log.txt"), file);
        log.info("a");
    }
    EXPECT_EQ(test::read_text(directory.path("log.txt")), "a\na\n");
}

TEST(Log, says_no_control_characters)
{
    const test::TemporaryDirectory directory;
    ::testing::internal::CaptureStdout();
    Log log(world(), Terminal::shown);
    log.open(directory.path("log.txt"));
    log.info("title \x1b]0;mine\x07 of gr\xc3\xbc\xc3\x9f\xc2\x9b"
             "e\tone\ntwo\r\x7f");
    const std::string wanted = "title \\x1b]0;mine\\x07 of gr\xc3\xbc\xc3\x9f\\u009be\tone\ntwo\\x0d\\x7f\n";
    EXPECT_EQ(::testing::internal::GetCapturedStdout(), wanted);
    EXPECT_EQ(test::read_text(directory.path("log.txt")), wanted);
}

} // namespace
} // namespace tread
