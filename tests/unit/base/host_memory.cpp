#include <gmock/gmock.h>
#include <sys/resource.h>

#include "base/bytes_text.hpp"
#include "base/errors.hpp"
#include "base/host_memory.hpp"
#include "base/saturated.hpp"

namespace
{

using namespace tread;
using ::testing::HasSubstr;

TEST(HostMemory, MoreThanThereIsIsRefusedWithBothFigures)
{
    require_host_memory({1e6, "a megabyte", "nothing"});
    try
    {
        require_host_memory({1e18, "[[terrain]] 0: its 1e+16 points", "a coarser grid"});
        FAIL() << "was accepted";
    }
    catch (const EnvironmentError& error)
    {
        EXPECT_EQ(error.code(), ExitCode::environment);
        EXPECT_THAT(error.what(),
                    HasSubstr("out of host memory: [[terrain]] 0: its 1e+16 points take about over 1e6 TB, "));
        EXPECT_THAT(error.what(), HasSubstr("B is free: a coarser grid, or a machine with more memory"));
    }
}

/// Asked in a process of its own, which keeps the limit.
TEST(HostMemory, AnAddressSpaceLimitCounts)
{
    const auto ask = []
    {
        const std::int64_t before = available_host_memory();
        const rlimit       limit{rlim_t{4} << 30, rlim_t{4} << 30};
        if (setrlimit(RLIMIT_AS, &limit) != 0) { std::exit(3); }
        const std::int64_t after = available_host_memory();
        std::exit(before > 0 && after >= 0 && after < (std::int64_t{4} << 30) ? 0 : 1);
    };
    EXPECT_EXIT(ask(), ::testing::ExitedWithCode(0), "");
}

TEST(Saturated, StaysWithin64Bits)
{
    constexpr auto most = std::numeric_limits<std::int64_t>::max();
    EXPECT_EQ(saturated(12.7), 12);
    EXPECT_EQ(saturated(9.3e18), most);
    EXPECT_EQ(saturated(std::numeric_limits<double>::infinity()), most);
    EXPECT_EQ(saturated(std::numeric_limits<double>::quiet_NaN()), most);
    EXPECT_EQ(saturated(-1), 0);
}

TEST(BytesText, LargeSizes)
{
    EXPECT_EQ(bytes_text(2'500'000'000), "2.50 GB");
    EXPECT_EQ(bytes_text(2'500'000'000'000), "2.5 TB");
    EXPECT_EQ(bytes_text(std::numeric_limits<std::int64_t>::max()), "over 1e6 TB");
}

} // namespace
