#include <cstdint>
#include <cstdio>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "rank_run.hpp"
#include "solver/bodies/dem_solver.hpp"

// MPI calls of a run by name: none for a scene on one rank, and for sand on several ranks those that its parts need.
// Calls are intercepted through MPI's profiling interface.
namespace
{

using namespace tread;

std::set<std::string>& called()
{
    static std::set<std::string> names;
    return names;
}

} // namespace

extern "C"
{
    int MPI_Allgather(const void* from, int count, MPI_Datatype type, void* to, int each, MPI_Datatype of,
                      MPI_Comm comm)
    {
        called().insert("Allgather");
        return PMPI_Allgather(from, count, type, to, each, of, comm);
    }

    int MPI_Allgatherv(const void* from, int count, MPI_Datatype type, void* to, const int* counts, const int* first,
                       MPI_Datatype of, MPI_Comm comm)
    {
        called().insert("Allgatherv");
        return PMPI_Allgatherv(from, count, type, to, counts, first, of, comm);
    }

    int MPI_Allreduce(const void* from, void* to, int count, MPI_Datatype type, MPI_Op op, MPI_Comm comm)
    {
        called().insert("Allreduce");
        return PMPI_Allreduce(from, to, count, type, op, comm);
    }

    int MPI_Alltoall(const void* from, int count, MPI_Datatype type, void* to, int each, MPI_Datatype of, MPI_Comm comm)
    {
        called().insert("Alltoall");
        return PMPI_Alltoall(from, count, type, to, each, of, comm);
    }

    int MPI_Alltoallv(const void* from, const int* counts, const int* first, MPI_Datatype type, void* to,
                      const int* each, const int* at, MPI_Datatype of, MPI_Comm comm)
    {
        called().insert("Alltoallv");
        return PMPI_Alltoallv(from, counts, first, type, to, each, at, of, comm);
    }

    int MPI_Bcast(void* data, int count, MPI_Datatype type, int root, MPI_Comm comm)
    {
        called().insert("Bcast");
        return PMPI_Bcast(data, count, type, root, comm);
    }

    int MPI_Barrier(MPI_Comm comm)
    {
        called().insert("Barrier");
        return PMPI_Barrier(comm);
    }

    int MPI_Isend(const void* data, int count, MPI_Datatype type, int to, int tag, MPI_Comm comm, MPI_Request* request)
    {
        called().insert("Isend");
        return PMPI_Isend(data, count, type, to, tag, comm, request);
    }

    int MPI_Irecv(void* data, int count, MPI_Datatype type, int from, int tag, MPI_Comm comm, MPI_Request* request)
    {
        called().insert("Irecv");
        return PMPI_Irecv(data, count, type, from, tag, comm, request);
    }
}

namespace
{

std::set<std::string> calls_of_steps(const std::string& text, test::Ranks ranks)
{
    Counters                   counters;
    test::RankRun<Cpu, double> run(Cpu{&counters}, text, ranks);
    called().clear();
    run.step(5);
    return called();
}

using Names = std::set<std::string>;

TEST(LeftOutOnRanks, OneRankAloneAsksNothingOfMpi)
{
    EXPECT_EQ(calls_of_steps(test::sand_text, test::Ranks::this_one), Names{});
}

/// Five steps of a bed at rest, with checksums of migrating points.
TEST(LeftOutOnRanks, SandOnSeveralAsksForWhatItShares)
{
    if (test::world().size() == 1) { GTEST_SKIP() << "one rank"; }
    EXPECT_EQ(calls_of_steps(test::sand_text, test::Ranks::all), (Names{"Allgather", "Irecv", "Isend"}));
}

/// Two balls, in no one's way, that drift slowly: lists of pairs expire, and who holds the balls does not change.
std::string drifting()
{
    std::string text = test::steel_text;
    for (const int x : {1, 2})
    {
        text += fmt::format("[[body]]\nname = \"ball_{0}\"\nshape = \"ball\"\nmaterial = \"steel\"\ndiameter = 0.1\n"
                            "density = 7800.0\nposition = [{0}.0, 0.5, 0.5]\nvelocity = [0.0, 0.02, 0.0]\n",
                            x);
    }
    return text + "[[phase]]\nname = \"drift\"\nduration = 1.0\n";
}

TEST(LeftOutOnRanks, ASearchThatChangesNoHolderExchangesNoBodies)
{
    if (test::world().size() == 1) { GTEST_SKIP() << "one rank"; }
    Counters                   counters;
    test::RankRun<Cpu, double> run(Cpu{&counters}, drifting(), test::Ranks::all,
                                   [](const mpm::Index3& page) { return page.y & 1; });
    solver::DemSolver<Cpu>&    rigid = run.simulation().rigid();
    const double               dt    = 1e-3; // s
    rigid.command(std::vector<solver::BodyCommand>(2));
    rigid.find_pairs(dt);
    EXPECT_EQ(rigid.shares(), test::world().rank() < 2);
    const std::int64_t first = rigid.partition_version();
    called().clear();
    for (int step = 0; step < 300; ++step)
    {
        rigid.run(dt, 0, 1);
        rigid.take_done(dt);
        rigid.find_pairs(dt);
    }
    const std::int64_t searches = rigid.partition_version() - first;
    std::printf("%d searches in 300 steps\n", static_cast<int>(searches));
    EXPECT_GT(searches, 5);
    EXPECT_FALSE(called().contains("Alltoall") || called().contains("Alltoallv"));
}

} // namespace
