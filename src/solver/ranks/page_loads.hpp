#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "decomp/decomposition.hpp"
#include "decomp/page_graph.hpp"
#include "decomp/page_ownership.hpp"
#include "world/world.hpp"

namespace tread::solver
{

/// Work of a body in points: 15 points per substep (docs/performance.md) times ten substeps, the usual number for beds
/// of rocks.
inline constexpr double body_load = 150;

/// Work of one that sleeps: it is looked at once a step, and sorted into a cell where pairs are found.
inline constexpr double body_load_asleep = 1; // assumed

/// Describes a partition for the log: "largest load 1.02 of the mean ...".
std::string describe_partition(const decomp::PageGraph& graph, const decomp::Partition& found, int ranks);

/// Lattice that maps positions to the pages of page_graph_of.
decomp::PageLattice page_lattice_of(const world::World& world);

/// Pages of a world at its start.
struct WorldPages
{
    decomp::PageGraph          graph;     ///< of those that hold points or centres of bodies, with their loads
    std::vector<std::uint64_t> with_sand; ///< those that hold points, ascending
};

/// Finds the pages of a world that has its rocks still. Without points pages are four bodies wide.
WorldPages pages_of(const world::World& world);

/// Collective: assigns every page of a world to a rank. Returns a description for the log.
template<class Exec>
std::string share_out(decomp::Decomposition<Exec>& decomposition, const world::World& world)
{
    const WorldPages         pages = pages_of(world);
    decomp::PartitionOptions options;
    options.ranks                 = decomposition.ranks();
    const decomp::Partition found = decomp::make_partition(decomposition.communicator, pages.graph, options);
    decomposition.owners.assign(pages.graph.key, found.rank);
    decomposition.owners.enter_sand(pages.with_sand);
    return describe_partition(pages.graph, found, options.ranks);
}

/// Collective: describes the partition of a world over `ranks`, one line for each partitioner.
std::string partition_lines(const Communicator& communicator, const world::World& world, int ranks);

} // namespace tread::solver
