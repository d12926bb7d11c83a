#include "decomp/partition.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace tread::decomp
{
namespace
{

double sum_of(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

/// Largest load that counts. A page heavier than a rank's share gets a rank of its own, so it counts as the share of
/// the others.
double most_that_counts(std::vector<double> load, int ranks)
{
    std::sort(load.begin(), load.end(), std::greater<>());
    double rest = sum_of(load);
    int    own  = 0;
    while (own < ranks - 1 && load[static_cast<std::size_t>(own)] * (ranks - own) > rest)
    {
        rest -= load[static_cast<std::size_t>(own)];
        ++own;
    }
    return rest / (ranks - own);
}

/// Describes the fault of a partitioner's result; empty if there is none.
std::string fault(const PartitionQuality& found, const PartitionQuality& chunks, const PartitionOptions& options)
{
    if (found.empty > 0) { return fmt::format("it left {} of {} ranks without a page", found.empty, options.ranks); }
    if (found.imbalance > std::max(options.imbalance, chunks.imbalance) * 1.01)
    {
        return fmt::format("it gives {:.3f} times the mean load to a rank, runs of page keys {:.3f}", found.imbalance,
                           chunks.imbalance);
    }
    return {};
}

} // namespace

std::vector<std::int32_t> whole_loads(const std::vector<double>& load, int ranks)
{
    constexpr double most_in_all = 1 << 30;
    const double     most        = most_that_counts(load, ranks);
    const auto       counted     = [most](double sum, double value) { return sum + std::min(value, most); };
    const double     total       = std::accumulate(load.begin(), load.end(), 0.0, counted);
    const double     unit        = total > 0 ? (most_in_all - static_cast<double>(load.size())) / total : 0.0;

    std::vector<std::int32_t> whole;
    whole.reserve(load.size());
    for (const double value : load)
    {
        whole.push_back(1 + static_cast<std::int32_t>(std::floor(unit * std::min(value, most))));
    }
    return whole;
}

PageRanks morton_chunks(const PageGraph& graph, int ranks)
{
    const std::size_t pages = graph.pages();
    const double      total = sum_of(graph.load);
    PageRanks         rank;
    double            before = 0;
    for (std::size_t page = 0; page < pages; ++page)
    {
        const double share  = total > 0 ? (before + 0.5 * graph.load[page]) / total
                                        : static_cast<double>(page) / static_cast<double>(pages);
        const int    wanted = static_cast<int>(share * ranks);
        const int    least =
            ranks - static_cast<int>(
                        std::min(pages - page, static_cast<std::size_t>(ranks))); // leaves one page for each later rank
        const int last = rank.empty() ? -1 : rank.back();
        rank.push_back(std::clamp(std::max(wanted, least), std::max(last, 0), std::min(last + 1, ranks - 1)));
        before += graph.load[page];
    }
    return rank;
}

PageRanks stay_put(const PageRanks& parts, const PageRanks& present, const std::vector<double>& load, int ranks)
{
    const auto          n = static_cast<std::size_t>(ranks);
    std::vector<double> common(n * n, 0.0);
    for (std::size_t page = 0; page < parts.size(); ++page)
    {
        if (present[page] >= 0)
        {
            common[static_cast<std::size_t>(parts[page]) * n + static_cast<std::size_t>(present[page])] += load[page];
        }
    }
    std::vector<std::size_t> order(n * n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return common[a] > common[b]; });
    std::vector<std::int32_t> name(n, -1);
    std::vector<bool>         taken(n, false);
    for (const std::size_t pair : order)
    {
        const std::size_t part = pair / n, rank = pair % n;
        if (name[part] >= 0 || taken[rank]) { continue; }
        name[part]  = static_cast<std::int32_t>(rank);
        taken[rank] = true;
    }
    PageRanks renamed;
    renamed.reserve(parts.size());
    for (const std::int32_t part : parts) { renamed.push_back(name[static_cast<std::size_t>(part)]); }
    return renamed;
}

PartitionQuality quality_of(const PageGraph& graph, const PageRanks& rank, int ranks)
{
    PartitionQuality                                quality;
    std::vector<double>                             load(static_cast<std::size_t>(ranks), 0.0);
    std::vector<int>                                pages(static_cast<std::size_t>(ranks), 0);
    std::set<std::pair<std::int32_t, std::int32_t>> halo; // rank, page of another
    for (std::size_t page = 0; page < graph.pages(); ++page)
    {
        const std::int32_t own = rank[page];
        load[static_cast<std::size_t>(own)] += graph.load[page];
        ++pages[static_cast<std::size_t>(own)];
        for (std::int64_t edge = graph.first[page]; edge < graph.first[page + 1]; ++edge)
        {
            const std::int32_t other = graph.neighbour[static_cast<std::size_t>(edge)];
            if (rank[static_cast<std::size_t>(other)] == own) { continue; }
            quality.cut += graph.shared[static_cast<std::size_t>(edge)];
            halo.emplace(own, other);
        }
    }
    quality.cut /= 2;
    const double mean = sum_of(load) / ranks;
    if (mean > 0) { quality.imbalance = *std::max_element(load.begin(), load.end()) / mean; }
    quality.empty = static_cast<int>(std::count(pages.begin(), pages.end(), 0));
    std::vector<std::int64_t> met(static_cast<std::size_t>(ranks), 0);
    for (const auto& [own, page] : halo) { ++met[static_cast<std::size_t>(own)]; }
    quality.halo = *std::max_element(met.begin(), met.end());
    return quality;
}

Partition make_partition(const Communicator& communicator, const PageGraph& graph, const PartitionOptions& options)
{
    const PageRanks chunks = morton_chunks(graph, options.ranks);
    if (options.partitioner == Partitioner::morton || options.ranks == 1) { return {chunks, {}}; }
    if (graph.pages() < static_cast<std::size_t>(options.ranks))
    {
        return {chunks, fmt::format("{} pages for {} ranks", graph.pages(), options.ranks)};
    }
    const PageRanks   parts = options.partitioner == Partitioner::metis
                                  ? metis_parts(graph, options.ranks, options.imbalance)
                                  : petsc_parts(communicator, graph, options.ranks, options.imbalance);
    const std::string wrong =
        fault(quality_of(graph, parts, options.ranks), quality_of(graph, chunks, options.ranks), options);
    return wrong.empty() ? Partition{parts, {}} : Partition{chunks, wrong};
}

} // namespace tread::decomp
