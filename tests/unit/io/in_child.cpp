#include "io/in_child.hpp"

#include <csignal>
#include <cstdlib>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "base/errors.hpp"

namespace tread::io
{
namespace
{

/// Error message of a child.
std::string error_of(const std::function<std::string()>& work, const ChildLimits& limits = {})
{
    try
    {
        run_in_child("that", work, limits);
    }
    catch (const EnvironmentError& error)
    {
        return error.what();
    }
    return "no error";
}

TEST(InChild, GivesTheTextAndTheError)
{
    const std::string long_text(std::size_t{1} << 20, 'x');
    EXPECT_EQ(run_in_child("that", [&] { return long_text; }), long_text);
    EXPECT_EQ(error_of([]() -> std::string { throw InputError("no such thing"); }), "no such thing");
}

TEST(InChild, ItsEndIsNotOurs)
{
    EXPECT_EQ(error_of(
                  []() -> std::string
                  {
                      raise(SIGSEGV);
                      return "";
                  }),
              "that: HDF5 cannot bear it (signal 11); the file is damaged");
    const std::string too_long = error_of(
        []() -> std::string
        {
            for (;;) { std::this_thread::sleep_for(std::chrono::seconds(1)); }
        },
        {1, 1, std::int64_t{1} << 30, 1000});
    EXPECT_EQ(too_long, "that: takes too long or too much; the file is damaged");
    const std::string too_much = error_of([] { return std::string(2000, 'x'); }, {1, 1, std::int64_t{1} << 30, 1000});
    EXPECT_EQ(too_much, too_long);
}

} // namespace
} // namespace tread::io
