#pragma once

#include <string>

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

/// Describes a partition for the log: "largest load 1.02 of the mean ...".
std::string describe_partition(const decomp::PageGraph& graph, const decomp::Partition& found, int ranks);

/// Lattice that maps positions to the pages of page_graph_of.
decomp::PageLattice page_lattice_of(const world::World& world);

/// Builds the graph of pages that hold points or centres of bodies, with their loads. Without points pages are four
/// bodies wide.
decomp::PageGraph page_graph_of(const world::World& world);

/// Collective: assigns every page of a world to a rank. Returns a description for the log.
template<class Exec>
std::string share_out(decomp::Decomposition<Exec>& decomposition, const world::World& world)
{
    const decomp::PageGraph  graph = page_graph_of(world);
    decomp::PartitionOptions options;
    options.ranks                 = decomposition.ranks();
    const decomp::Partition found = decomp::make_partition(decomposition.communicator, graph, options);
    decomposition.owners.assign(graph.key, found.rank);
    return describe_partition(graph, found, options.ranks);
}

/// Collective: describes the partition of a world over `ranks`, one line for each partitioner.
std::string partition_lines(const Communicator& communicator, const world::World& world, int ranks);

} // namespace tread::solver
