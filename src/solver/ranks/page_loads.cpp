#include "solver/ranks/page_loads.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "decomp/partition.hpp"
#include "kernels/mpm/pages/pages.hpp"
#include "solver/ranks/page_runs.hpp"

namespace tread::solver
{
namespace
{

/// m, grid spacing. Without sand, a median diameter of the bodies.
double spacing_of(const world::World& world)
{
    return world.sand.size() > 0 || world.bodies.size() == 0 ? world.geometry.spacing : world.middle_diameter;
}

using Loads = std::unordered_map<std::uint64_t, double>;

/// Ascending.
std::vector<std::uint64_t> keys_of(const Loads& loads)
{
    std::vector<std::uint64_t> keys;
    keys.reserve(loads.size());
    for (const auto& [page, load] : loads) { keys.push_back(page); }
    std::sort(keys.begin(), keys.end());
    return keys;
}

std::string line_of(const Communicator& communicator, const decomp::PageGraph& graph, const char* name,
                    const decomp::PartitionOptions& options)
{
    const decomp::Partition found = decomp::make_partition(communicator, graph, options);
    return fmt::format("  {:<8}{}\n", name, describe_partition(graph, found, options.ranks));
}

} // namespace

std::string describe_partition(const decomp::PageGraph& graph, const decomp::Partition& found, int ranks)
{
    const decomp::PartitionQuality quality = decomp::quality_of(graph, found.rank, ranks);
    std::string text = fmt::format("largest load {:.3f} of the mean, {} nodes shared across ranks, at most {} pages of "
                                   "others beside one",
                                   quality.imbalance, quality.cut, quality.halo);
    if (quality.empty > 0) { text += fmt::format(", {} ranks without pages", quality.empty); }
    if (!found.fallback.empty()) { text += fmt::format(" (by Morton order: {})", found.fallback); }
    return text;
}

decomp::PageLattice page_lattice_of(const world::World& world)
{
    return {spacing_of(world), world.geometry.stencil_shift};
}

WorldPages pages_of(const world::World& world)
{
    world.bodies.require_rocks();
    const mpm::Lattice lattice = mpm::make_lattice(spacing_of(world), world.geometry.stencil_shift);
    Loads              loads;
    for (const world::PointRow& row : world.sand.rows)
    {
        for_each_page_run(lattice, row,
                          [&](std::uint64_t page, std::uint32_t from, std::uint32_t to)
                          { loads[page] += static_cast<double>(to - from); });
    }
    std::vector<std::uint64_t> with_sand = keys_of(loads);
    for (const Vec3<double>& at : world.bodies.position)
    {
        loads[mpm::page_key(mpm::page_of(mpm::cell_of(at, lattice)))] += body_load;
    }
    std::vector<std::uint64_t> key = keys_of(loads);
    std::vector<double>        load;
    load.reserve(key.size());
    for (const std::uint64_t page : key) { load.push_back(loads.at(page)); }
    return {decomp::page_graph(std::move(key), std::move(load)), std::move(with_sand)};
}

std::string partition_lines(const Communicator& communicator, const world::World& world, int ranks)
{
    const decomp::PageGraph  graph = pages_of(world).graph;
    decomp::PartitionOptions options;
    options.ranks    = ranks;
    std::string text = fmt::format("partition of {} pages into {} ranks:\n", graph.pages(), ranks);
    text += line_of(communicator, graph, "METIS", options);
    if (decomp::petsc_is_built_in())
    {
        options.partitioner = decomp::Partitioner::petsc;
        text += line_of(communicator, graph, "PETSc", options);
    }
    options.partitioner = decomp::Partitioner::morton;
    return text + line_of(communicator, graph, "Morton", options);
}

} // namespace tread::solver
