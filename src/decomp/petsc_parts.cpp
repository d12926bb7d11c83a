#include "decomp/partition.hpp"

#include "base/errors.hpp"

#ifdef TREAD_WITH_PETSC

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include <fmt/format.h>
#include <petscmat.h>
#include <scotch.h>

namespace tread::decomp
{
namespace
{

void check_petsc(PetscErrorCode code, const char* call)
{
    if (code == 0) { return; }
    const char* text = nullptr;
    PetscErrorMessage(code, &text, nullptr);
    throw EnvironmentError(fmt::format("PETSc: {} failed: {}", call, text == nullptr ? "unknown error" : text));
}

/// PETSc session, initialised and finalised by its lifetime, without signal handlers; errors are returned to the
/// caller.
struct Library
{
    Library()
    {
        setenv("SCOTCH_PTHREAD_NUMBER", "1", 1); // its threads race: four ranks got different parts each time
        check_petsc(PetscInitializeNoArguments(), "PetscInitialize");
        check_petsc(PetscPopSignalHandler(), "PetscPopSignalHandler");
        check_petsc(PetscPushErrorHandler(PetscReturnErrorHandler, nullptr), "PetscPushErrorHandler");
    }
    ~Library() { PetscFinalize(); }
    Library(const Library&)            = delete;
    Library& operator=(const Library&) = delete;
};

/// Copies an array into memory that PETSc will free.
template<class From>
PetscInt* copy_for_petsc(From begin, From end)
{
    PetscInt* copy = nullptr;
    check_petsc(PetscMalloc1(std::max<std::ptrdiff_t>(1, end - begin), &copy), "PetscMalloc1");
    std::transform(begin, end, copy, [](auto value) { return static_cast<PetscInt>(value); });
    return copy;
}

/// Pages of one rank while PETSc works: any split will do.
struct Rows
{
    std::size_t begin, end;
};

Rows rows_of(const Communicator& communicator, std::size_t pages)
{
    const auto rank = static_cast<std::size_t>(communicator.rank()),
               size = static_cast<std::size_t>(communicator.size());
    return {pages * rank / size, pages * (rank + 1) / size};
}

struct Graph
{
    Graph(const Communicator& communicator, const PageGraph& graph, const Rows& rows)
    {
        const auto                at    = [](auto& values, std::int64_t place) { return values.begin() + place; };
        const std::int64_t        begin = graph.first[rows.begin], end = graph.first[rows.end];
        std::vector<std::int64_t> first(at(graph.first, static_cast<std::int64_t>(rows.begin)),
                                        at(graph.first, static_cast<std::int64_t>(rows.end) + 1));
        for (std::int64_t& edge : first) { edge -= begin; }
        check_petsc(MatCreateMPIAdj(communicator.native(), static_cast<PetscInt>(rows.end - rows.begin),
                                    static_cast<PetscInt>(graph.pages()), copy_for_petsc(first.begin(), first.end()),
                                    copy_for_petsc(at(graph.neighbour, begin), at(graph.neighbour, end)),
                                    copy_for_petsc(at(graph.shared, begin), at(graph.shared, end)), &matrix),
                    "MatCreateMPIAdj");
    }
    ~Graph() { MatDestroy(&matrix); }
    Graph(const Graph&)            = delete;
    Graph& operator=(const Graph&) = delete;

    Mat matrix = nullptr;
};

struct Partitioning
{
    explicit Partitioning(const Communicator& communicator)
    {
        check_petsc(MatPartitioningCreate(communicator.native(), &object), "MatPartitioningCreate");
    }
    ~Partitioning()
    {
        ISDestroy(&parts);
        MatPartitioningDestroy(&object);
    }
    Partitioning(const Partitioning&)            = delete;
    Partitioning& operator=(const Partitioning&) = delete;

    MatPartitioning object = nullptr;
    IS              parts  = nullptr;
};

/// Parts of this rank's rows.
std::vector<std::int32_t> own_parts(const Partitioning& partitioning, const Rows& rows)
{
    const PetscInt* found = nullptr;
    check_petsc(ISGetIndices(partitioning.parts, &found), "ISGetIndices");
    std::vector<std::int32_t> own(found, found + (rows.end - rows.begin));
    check_petsc(ISRestoreIndices(partitioning.parts, &found), "ISRestoreIndices");
    return own;
}

} // namespace

bool petsc_is_built_in() { return true; }

PageRanks petsc_parts(const Communicator& communicator, const PageGraph& graph, int ranks, double imbalance)
{
    const Library                   library;
    const Rows                      rows  = rows_of(communicator, graph.pages());
    const std::vector<std::int32_t> loads = whole_loads(graph.load, ranks);
    const Graph                     adjacency(communicator, graph, rows);
    Partitioning                    partitioning(communicator);
    const auto                      begin = loads.begin() + static_cast<std::ptrdiff_t>(rows.begin);
    const auto                      end   = loads.begin() + static_cast<std::ptrdiff_t>(rows.end);
    check_petsc(MatPartitioningSetAdjacency(partitioning.object, adjacency.matrix), "MatPartitioningSetAdjacency");
    check_petsc(MatPartitioningSetType(partitioning.object, MATPARTITIONINGPTSCOTCH), "MatPartitioningSetType");
    check_petsc(MatPartitioningSetNParts(partitioning.object, ranks), "MatPartitioningSetNParts");
    check_petsc(MatPartitioningSetUseEdgeWeights(partitioning.object, PETSC_TRUE), "MatPartitioningSetUseEdgeWeights");
    check_petsc(MatPartitioningSetVertexWeights(partitioning.object, copy_for_petsc(begin, end)),
                "MatPartitioningSetVertexWeights");
    check_petsc(MatPartitioningPTScotchSetImbalance(partitioning.object, imbalance - 1),
                "MatPartitioningPTScotchSetImbalance");
    SCOTCH_randomSeed(1); // otherwise a process's second partition differs from its first
    check_petsc(MatPartitioningApply(partitioning.object, &partitioning.parts), "MatPartitioningApply");
    return communicator.gather(own_parts(partitioning, rows));
}

} // namespace tread::decomp

#else

namespace tread::decomp
{

bool petsc_is_built_in() { return false; }

PageRanks petsc_parts(const Communicator&, const PageGraph&, int, double)
{
    throw EnvironmentError("this tread was built without PETSc (-DTREAD_PETSC=OFF)");
}

} // namespace tread::decomp

#endif
