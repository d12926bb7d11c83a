#include <fstream>

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <unistd.h>

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

TEST(HostMemory, AnAddressSpaceLimitCounts)
{
    constexpr std::int64_t more = std::int64_t{256} << 20;
    rlimit                 before{};
    ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
    std::int64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlimit limit{static_cast<rlim_t>(pages * sysconf(_SC_PAGESIZE) + more), before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_AS, &limit), 0);
    const std::int64_t left = available_host_memory();
    ASSERT_EQ(setrlimit(RLIMIT_AS, &before), 0);
    EXPECT_LE(left, more);
    EXPECT_GE(left, more / 2);
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
