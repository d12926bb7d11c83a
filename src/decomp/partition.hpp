#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "decomp/page_graph.hpp"

// Assignment of pages to ranks.
namespace tread::decomp
{

/// Rank of every page of a graph.
using PageRanks = std::vector<std::int32_t>;

enum class Partitioner
{
    metis, ///< k-way (Karypis and Kumar 1998), computed by every rank: least cut under the bound on imbalance
    petsc, ///< PTScotch through PETSc's MatPartitioning, computed by all ranks together: for graphs too large for one
           ///< rank
    morton ///< contiguous runs of keys: ignores edges, never fails
};

struct PartitionOptions
{
    int         ranks       = 1;
    Partitioner partitioner = Partitioner::metis;
    double      imbalance   = 1.05; ///< requested bound on the largest load over the mean
};

struct Partition
{
    PageRanks   rank;
    std::string fallback; ///< reason if Morton order replaced the requested partitioner; else empty
};

/// Partitions a graph; no rank is empty if there are at least as many pages as ranks. Collective; all ranks pass the
/// same graph and get the same partition. A partitioner's result that leaves a rank empty, or exceeds the imbalance of
/// both Morton chunks and the options, is replaced by Morton chunks, and `fallback` gives the reason.
Partition make_partition(const Communicator& communicator, const PageGraph& graph, const PartitionOptions& options);

/// Splits pages into contiguous runs of keys of nearly equal load; with fewer pages than ranks the last ranks get none.
PageRanks morton_chunks(const PageGraph& graph, int ranks);

/// Partitions by METIS k-way with a fixed seed. It may leave ranks empty if loads are very uneven. EnvironmentError if
/// METIS reports an error. Needs at least two ranks and as many pages.
PageRanks metis_parts(const PageGraph& graph, int ranks, double imbalance);

/// Partitions by PTScotch. Collective. EnvironmentError without PETSc, or if it reports an error. Needs as many pages
/// as ranks.
PageRanks petsc_parts(const Communicator& communicator, const PageGraph& graph, int ranks, double imbalance);
bool      petsc_is_built_in();

/// Loads as integers for the partitioners, none 0, with a sum that fits 32 bits. A page heavier than a rank's share,
/// which would leave ranks empty, is capped at that share.
std::vector<std::int32_t> whole_loads(const std::vector<double>& load, int ranks);

/// Relabels the parts so that most load stays on its rank, to minimise migration. `present`: current ranks of the
/// pages, -1 for new pages. Greedy by the largest common load; ties by rank.
PageRanks stay_put(const PageRanks& parts, const PageRanks& present, const std::vector<double>& load, int ranks);

struct PartitionQuality
{
    double       imbalance = 1; ///< largest load over the mean of all ranks
    std::int64_t cut       = 0; ///< nodes shared by pages of different ranks, summed over pairs of pages
    std::int64_t halo      = 0; ///< most pages of other ranks with which any rank shares nodes
    int          empty     = 0; ///< ranks without a page
};

PartitionQuality quality_of(const PageGraph& graph, const PageRanks& rank, int ranks);

} // namespace tread::decomp
