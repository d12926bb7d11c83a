#include "mpi_calls.hpp"

#include <mpi.h>

// Intercepts MPI calls of this program and its libraries through MPI's profiling interface.
namespace tread::test
{

std::set<std::string>& mpi_calls()
{
    static std::set<std::string> calls;
    return calls;
}

} // namespace tread::test

namespace
{

template<class Function, class... Arguments>
int noted(const char* name, Function function, Arguments... arguments)
{
    tread::test::mpi_calls().insert(name);
    return function(arguments...);
}

} // namespace

extern "C"
{
    int MPI_Allgather(const void* from, int count, MPI_Datatype type, void* to, int each, MPI_Datatype as,
                      MPI_Comm comm)
    {
        return noted("MPI_Allgather", PMPI_Allgather, from, count, type, to, each, as, comm);
    }

    int MPI_Allgatherv(const void* from, int count, MPI_Datatype type, void* to, const int* each, const int* places,
                       MPI_Datatype as, MPI_Comm comm)
    {
        return noted("MPI_Allgatherv", PMPI_Allgatherv, from, count, type, to, each, places, as, comm);
    }

    int MPI_Allreduce(const void* from, void* to, int count, MPI_Datatype type, MPI_Op operation, MPI_Comm comm)
    {
        return noted("MPI_Allreduce", PMPI_Allreduce, from, to, count, type, operation, comm);
    }

    int MPI_Alltoall(const void* from, int count, MPI_Datatype type, void* to, int each, MPI_Datatype as, MPI_Comm comm)
    {
        return noted("MPI_Alltoall", PMPI_Alltoall, from, count, type, to, each, as, comm);
    }

    int MPI_Alltoallv(const void* from, const int* counts, const int* starts, MPI_Datatype type, void* to,
                      const int* each, const int* places, MPI_Datatype as, MPI_Comm comm)
    {
        return noted("MPI_Alltoallv", PMPI_Alltoallv, from, counts, starts, type, to, each, places, as, comm);
    }

    int MPI_Barrier(MPI_Comm comm) { return noted("MPI_Barrier", PMPI_Barrier, comm); }

    int MPI_Ibarrier(MPI_Comm comm, MPI_Request* request)
    {
        return noted("MPI_Ibarrier", PMPI_Ibarrier, comm, request);
    }

    int MPI_Bcast(void* data, int count, MPI_Datatype type, int root, MPI_Comm comm)
    {
        return noted("MPI_Bcast", PMPI_Bcast, data, count, type, root, comm);
    }

    int MPI_Irecv(void* to, int count, MPI_Datatype type, int from, int tag, MPI_Comm comm, MPI_Request* request)
    {
        return noted("MPI_Irecv", PMPI_Irecv, to, count, type, from, tag, comm, request);
    }

    int MPI_Isend(const void* from, int count, MPI_Datatype type, int to, int tag, MPI_Comm comm, MPI_Request* request)
    {
        return noted("MPI_Isend", PMPI_Isend, from, count, type, to, tag, comm, request);
    }

    int MPI_Test(MPI_Request* request, int* done, MPI_Status* status)
    {
        return noted("MPI_Test", PMPI_Test, request, done, status);
    }

    int MPI_Waitall(int count, MPI_Request* requests, MPI_Status* statuses)
    {
        return noted("MPI_Waitall", PMPI_Waitall, count, requests, statuses);
    }

    int MPI_Comm_dup(MPI_Comm comm, MPI_Comm* copy) { return noted("MPI_Comm_dup", PMPI_Comm_dup, comm, copy); }
}
