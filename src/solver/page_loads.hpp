#pragma once

#include <string>

#include "base/communicator.hpp"
#include "decomp/decomposition.hpp"
#include "decomp/page_graph.hpp"
#include "decomp/page_ownership.hpp"
#include "world/world.hpp"

namespace tread::solver
{

/// A body's work in points: 15 a substep (2.1 ns against 0.14 ns a point and step on an H200, docs/performance.md), for
/// the ten substeps of a step that beds of rocks want.
inline constexpr double body_load = 150;

/// "largest load 1.02 of the mean ...".
std::string describe_partition(const decomp::PageGraph& graph, const decomp::Partition& found, int ranks);

/// How places fall to the pages of page_graph_of.
decomp::PageLattice page_lattice_of(const world::World& world);

/// The pages that hold points or centres of bodies, and what they weigh. Without points the pages are four bodies wide.
decomp::PageGraph page_graph_of(const world::World& world);

/// Collective: gives every page of a graph that all ranks have to one of them. Returns how, for the log.
template<class Exec>
std::string share_out(decomp::Decomposition<Exec>& decomposition, const decomp::PageGraph& graph)
{
    decomp::PartitionOptions options;
    options.ranks                 = decomposition.ranks();
    const decomp::Partition found = decomp::make_partition(decomposition.communicator, graph, options);
    decomposition.owners.assign(graph.key, found.rank);
    return describe_partition(graph, found, options.ranks);
}

/// The same of the pages of a world.
template<class Exec>
std::string share_out(decomp::Decomposition<Exec>& decomposition, const world::World& world)
{
    return share_out(decomposition, page_graph_of(world));
}

/// Collective: how a world falls to `ranks`, by each partitioner: a line each.
std::string partition_lines(const Communicator& communicator, const world::World& world, int ranks);

} // namespace tread::solver
