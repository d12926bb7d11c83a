#pragma once

#include <string>

#include "base/communicator.hpp"
#include "decomp/page_graph.hpp"
#include "solver/world.hpp"

namespace tread::solver
{

/// A body's work in points: 15 a substep (2.1 ns against 0.14 ns a point and step on an H200, docs/performance.md), for
/// the ten substeps of a step that beds of rocks want.
inline constexpr double body_load = 150;

/// The pages that hold points or centres of bodies, and what they weigh. Without points the pages are four bodies wide.
decomp::PageGraph page_graph_of(const World& world);

/// Collective: how a world falls to `ranks`, by each partitioner: a line each.
std::string partition_lines(const Communicator& communicator, const World& world, int ranks);

} // namespace tread::solver
