#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "decomp/page_graph.hpp"

// Which rank owns which page.
namespace tread::decomp
{

/// The rank of every page of a graph.
using PageRanks = std::vector<std::int32_t>;

enum class Partitioner
{
    metis, ///< k-way (Karypis and Kumar 1998), on every rank: least cut under the bound on imbalance
    petsc, ///< PTScotch through PETSc's MatPartitioning, by all ranks together: for graphs too large for one
    morton ///< runs of keys: no look at the edges, never fails
};

struct PartitionOptions
{
    int         ranks       = 1;
    Partitioner partitioner = Partitioner::metis;
    double      imbalance   = 1.05; ///< largest load over the mean that is asked for
};

struct Partition
{
    PageRanks   rank;
    std::string fallback; ///< why it is by Morton order, if something else was asked for; else empty
};

/// Collective: a partition in which no rank is empty while there are as many pages as ranks, the same on all ranks of
/// the communicator, which all have the same graph. What a partitioner returns is looked at: if it left a rank empty,
/// or is further out of balance than Morton chunks and the options allow, those are taken, and `fallback` says so.
Partition make_partition(const Communicator& communicator, const PageGraph& graph, const PartitionOptions& options);

/// Runs of keys, of nearly equal load; with fewer pages than ranks the last ranks get none.
PageRanks morton_chunks(const PageGraph& graph, int ranks);

/// METIS k-way with a fixed seed. It may leave ranks empty where loads are very uneven. EnvironmentError if METIS
/// reports one. At least two ranks and as many pages.
PageRanks metis_parts(const PageGraph& graph, int ranks, double imbalance);

/// Collective: PTScotch. EnvironmentError without PETSc, or if it reports one. As many pages as ranks.
PageRanks petsc_parts(const Communicator& communicator, const PageGraph& graph, int ranks, double imbalance);
bool      petsc_is_built_in();

/// Loads as partitioners count them, in 32-bit integers of which the sum fits one, none 0: a page that outweighs what a
/// rank should get, which would leave ranks empty, counts as that.
std::vector<std::int32_t> whole_loads(const std::vector<double>& load, int ranks);

/// The same parts under other names, so that most load stays where it is: `present` = the ranks of the pages now, -1 of
/// new pages. Largest common load first; ties by rank.
PageRanks stay_put(const PageRanks& parts, const PageRanks& present, const std::vector<double>& load, int ranks);

struct PartitionQuality
{
    double       imbalance = 1; ///< largest load over the mean of all ranks
    std::int64_t cut       = 0; ///< nodes that pages of different ranks share, summed over pairs of pages
    std::int64_t halo      = 0; ///< pages of other ranks that a rank shares nodes with, the most of any rank
    int          empty     = 0; ///< ranks without a page
};

PartitionQuality quality_of(const PageGraph& graph, const PageRanks& rank, int ranks);

} // namespace tread::decomp
