#include "base/communicator.hpp"

#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mpi_session.hpp"

namespace tread
{
namespace
{

using test::world;
using ::testing::HasSubstr;

class LauncherTest : public ::testing::Test
{
protected:
    void SetUp() override { forget_launcher(); }
    void TearDown() override { forget_launcher(); }

    static void forget_launcher()
    {
        for (const char* variable : {"SLURM_STEP_NUM_TASKS", "PMI_SIZE", "OMPI_COMM_WORLD_SIZE"})
        {
            unsetenv(variable);
        }
    }
};

TEST_F(LauncherTest, tasks_without_ranks_are_an_environment_error_with_the_hint)
{
    setenv("SLURM_STEP_NUM_TASKS", "4", 1);
    try
    {
        require_launcher_agrees(1);
        FAIL() << "no error";
    }
    catch (const EnvironmentError& error)
    {
        EXPECT_THAT(error.what(), HasSubstr("4 tasks"));
        EXPECT_THAT(error.what(), HasSubstr("--mpi=pmix"));
    }
}

TEST_F(LauncherTest, ranks_that_know_each_other_pass)
{
    setenv("SLURM_STEP_NUM_TASKS", "4", 1);
    EXPECT_NO_THROW(require_launcher_agrees(4));
    setenv("SLURM_STEP_NUM_TASKS", "1", 1);
    EXPECT_NO_THROW(require_launcher_agrees(1));
}

// A batch script sees SLURM_NTASKS of its allocation; a program that it starts directly is a single task all the same.
TEST_F(LauncherTest, allocation_of_many_tasks_is_not_a_launcher)
{
    setenv("SLURM_NTASKS", "4", 1);
    EXPECT_NO_THROW(require_launcher_agrees(1));
    unsetenv("SLURM_NTASKS");
}

TEST(Communicator, collectives)
{
    EXPECT_EQ(world().broadcast("scene text"), "scene text");
    EXPECT_EQ(world().sum(3), 3 * world().size());
    EXPECT_EQ(world().maximum(world().rank()), world().size() - 1);
    EXPECT_EQ(world().gather(2.5), std::vector<double>(static_cast<std::size_t>(world().size()), 2.5));
}

TEST(OnRoot, throws_what_the_root_threw)
{
    bool ran = false;
    on_root(world(), [&] { ran = true; });
    EXPECT_EQ(ran, world().rank() == 0);
    try
    {
        on_root(world(), [] { throw EnvironmentError("disk full"); });
        FAIL() << "no error";
    }
    catch (const Error& error)
    {
        EXPECT_EQ(error.code(), ExitCode::environment);
        EXPECT_STREQ(error.what(), "disk full");
    }
}

} // namespace
} // namespace tread
