#include <filesystem>
#include <fstream>
#include <limits>

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <unistd.h>

#include "base/bytes_text.hpp"
#include "base/errors.hpp"
#include "base/host_memory.hpp"
#include "base/saturated.hpp"
#include "temporary_directory.hpp"

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

/// A root directory whose only files are those of control groups.
class ControlGroups : public ::testing::Test
{
protected:
    void put(const std::string& file, const std::string& text) const
    {
        const std::filesystem::path path = directory.path(file);
        std::filesystem::create_directories(path.parent_path());
        std::ofstream(path) << text;
    }
    std::int64_t left() const { return memory_left_in_groups(directory.path("")); }

    test::TemporaryDirectory directory;
};

TEST_F(ControlGroups, NoneAndNoLimitLeaveAll)
{
    constexpr auto most = std::numeric_limits<std::int64_t>::max();
    EXPECT_EQ(left(), most);
    put("proc/self/cgroup", "0::/user.slice\n");
    EXPECT_EQ(left(), most);
    put("sys/fs/cgroup/user.slice/memory.max", "max\n");
    put("sys/fs/cgroup/user.slice/memory.current", "1000\n");
    EXPECT_EQ(left(), most);
}

TEST_F(ControlGroups, TheLeastOfAGroupAndItsParentsCounts)
{
    put("proc/self/cgroup", "0::/slurm/job_7/step_0\n");
    put("sys/fs/cgroup/slurm/job_7/step_0/memory.max", "max\n");
    put("sys/fs/cgroup/slurm/job_7/step_0/memory.current", "900\n");
    put("sys/fs/cgroup/slurm/job_7/memory.max", "10000\n");
    put("sys/fs/cgroup/slurm/job_7/memory.current", "4000\n");
    put("sys/fs/cgroup/slurm/memory.max", "70000\n");
    put("sys/fs/cgroup/slurm/memory.current", "5000\n");
    EXPECT_EQ(left(), 6000);
    put("sys/fs/cgroup/slurm/job_7/memory.stat", "anon 3000\ninactive_file 1500\n");
    EXPECT_EQ(left(), 7500) << "caches of files can be dropped";
    put("sys/fs/cgroup/slurm/memory.max", "4500\n");
    EXPECT_EQ(left(), 0) << "a parent that is full already";
}

TEST_F(ControlGroups, TheFirstVersionNamesItsController)
{
    put("proc/self/cgroup", "5:cpu,cpuacct:/other\n4:memory:/slurm/uid_0\n0::/\n");
    put("sys/fs/cgroup/memory/slurm/uid_0/memory.limit_in_bytes", "8000\n");
    put("sys/fs/cgroup/memory/slurm/uid_0/memory.usage_in_bytes", "3000\n");
    put("sys/fs/cgroup/memory/other/memory.limit_in_bytes", "10\n");
    put("sys/fs/cgroup/memory/other/memory.usage_in_bytes", "10\n");
    EXPECT_EQ(left(), 5000);
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
