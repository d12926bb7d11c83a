#include "run/threads.hpp"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <omp.h>

#include "mpi_session.hpp"

// Number of threads of a rank if ranks are on two machines: the last rank pretends to be on its own.
namespace
{

using namespace tread;
using test::world;

bool& last_is_apart()
{
    static bool is_apart = false;
    return is_apart;
}

} // namespace

// Intercepts the library's call through MPI's profiling interface.
extern "C" int MPI_Comm_split_type(MPI_Comm comm, int type, int key, MPI_Info info, MPI_Comm* part)
{
    if (!last_is_apart()) { return PMPI_Comm_split_type(comm, type, key, info, part); }
    int rank = 0, size = 1;
    PMPI_Comm_rank(comm, &rank);
    PMPI_Comm_size(comm, &size);
    return PMPI_Comm_split(comm, rank + 1 == size ? 1 : 0, key, part);
}

namespace
{

/// Two machines, and OMP_NUM_THREADS unset until the end of the test.
class ThreadsTest : public ::testing::Test
{
protected:
    void SetUp() override
    {
        last_is_apart() = true;
        if (const char* const set = std::getenv("OMP_NUM_THREADS")) { kept_ = set; }
        unsetenv("OMP_NUM_THREADS");
    }

    void TearDown() override
    {
        last_is_apart() = false;
        if (!kept_.empty()) { setenv("OMP_NUM_THREADS", kept_.c_str(), 1); }
    }

    static bool is_last() { return world().rank() + 1 == world().size(); }

private:
    std::string kept_;
};

TEST_F(ThreadsTest, ranks_of_a_machine_are_counted)
{
    EXPECT_EQ(world().local_size(), is_last() ? 1 : world().size() - 1);
    EXPECT_EQ(world().local_rank(), is_last() ? 0 : world().rank());
    last_is_apart() = false;
    EXPECT_EQ(world().local_size(), world().size());
}

// Only with two cores can a rank alone on its machine have more threads than cores over all ranks.
TEST_F(ThreadsTest, cores_are_shared_with_the_ranks_of_the_machine_alone)
{
    const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    EXPECT_EQ(tread::run::choose_threads(world(), 0), is_last() ? cores : std::max(1, cores / (world().size() - 1)));
}

TEST_F(ThreadsTest, what_is_asked_for_comes_first)
{
    EXPECT_EQ(tread::run::choose_threads(world(), 7), 7);
    // Set on one machine only: no rank may wait for the others.
    if (is_last()) { setenv("OMP_NUM_THREADS", "3", 1); }
    const int threads = tread::run::choose_threads(world(), 0);
    EXPECT_TRUE(!is_last() || threads == omp_get_max_threads());
    unsetenv("OMP_NUM_THREADS");
}

} // namespace
