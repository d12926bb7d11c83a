#include "decomp/balance.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "decomp/partition.hpp"

namespace tread::decomp
{
namespace
{

/// Steps of a point that it costs to pack, send, unpack and sort it, and to build what follows.
constexpr double move_cost = 20;

/// Steps of all points of a rank that a partition costs, whatever moves: METIS takes about a microsecond a page of some
/// 500 points, on every rank, beside the sorting of all points.
constexpr double partition_cost = 30;

double largest(const std::vector<double>& loads) { return *std::max_element(loads.begin(), loads.end()); }

double mean(const std::vector<double>& loads)
{
    return std::accumulate(loads.begin(), loads.end(), 0.0) / static_cast<double>(loads.size());
}

std::vector<double> loads_of(const PageGraph& graph, const PageRanks& rank, int ranks)
{
    std::vector<double> loads(static_cast<std::size_t>(ranks), 0.0);
    for (std::size_t page = 0; page < rank.size(); ++page)
    {
        loads[static_cast<std::size_t>(rank[page])] += graph.load[page];
    }
    return loads;
}

/// The pages of all ranks with their loads and owners.
struct AllPages
{
    PageGraph graph;
    PageRanks owner;
};

template<class Exec>
AllPages gather_pages(const Decomposition<Exec>& decomposition, const PageKeys& key, const std::vector<double>& load)
{
    const PageKeys            keys  = decomposition.communicator.gather(key);
    const std::vector<double> loads = decomposition.communicator.gather(load);
    std::vector<std::size_t>  order(keys.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return keys[a] < keys[b]; });
    PageKeys            sorted_keys;
    std::vector<double> sorted_loads;
    PageRanks           owner;
    for (const std::size_t i : order)
    {
        sorted_keys.push_back(keys[i]);
        sorted_loads.push_back(loads[i]);
        owner.push_back(decomposition.owners.owner(keys[i]));
    }
    return {page_graph(std::move(sorted_keys), std::move(sorted_loads)), std::move(owner)};
}

double moved_between(const AllPages& pages, const PageRanks& to)
{
    double moved = 0;
    for (std::size_t page = 0; page < to.size(); ++page)
    {
        if (to[page] != pages.owner[page]) { moved += pages.graph.load[page]; }
    }
    return moved;
}

} // namespace

double imbalance_of(const std::vector<double>& loads)
{
    const double middle = mean(loads);
    return middle > 0 ? largest(loads) / middle : 1;
}

bool BalanceRule::is_due(const std::vector<double>& loads, std::int64_t steps) const
{
    return imbalance_of(loads) > threshold_ &&
           (largest(loads) - mean(loads)) * static_cast<double>(steps) > partition_cost * mean(loads);
}

bool BalanceRule::is_worth(const std::vector<double>& now, const std::vector<double>& after, double moved,
                           std::int64_t steps) const
{
    const double gain = (largest(now) - largest(after)) * static_cast<double>(steps);
    return gain > partition_cost * mean(now) + move_cost * moved / static_cast<double>(now.size());
}

template<class Exec>
bool rebalance(Decomposition<Exec>& decomposition, const BalanceRule& rule, const PageKeys& key,
               const std::vector<double>& load, std::int64_t steps, BalanceRow& row)
{
    const std::vector<double> now = decomposition.communicator.gather(std::accumulate(load.begin(), load.end(), 0.0));
    row.imbalance                 = imbalance_of(now);
    row.loads                     = now;
    if (!rule.is_due(now, steps)) { return false; }
    const AllPages   pages = gather_pages(decomposition, key, load);
    PartitionOptions options;
    options.ranks             = decomposition.ranks();
    const Partition     parts = make_partition(decomposition.communicator, pages.graph, options);
    const PageRanks     ranks = stay_put(parts.rank, pages.owner, pages.graph.load, options.ranks);
    std::vector<double> after = loads_of(pages.graph, ranks, options.ranks);
    if (!rule.is_worth(now, after, moved_between(pages, ranks), steps)) { return false; }
    decomposition.owners.assign(pages.graph.key, ranks);
    row.imbalance = imbalance_of(after);
    row.loads     = std::move(after);
    ++row.repartitions;
    return true;
}

template bool rebalance(Decomposition<Cpu>&, const BalanceRule&, const PageKeys&, const std::vector<double>&,
                        std::int64_t, BalanceRow&);
#ifdef TREAD_WITH_CUDA
template bool rebalance(Decomposition<Gpu>&, const BalanceRule&, const PageKeys&, const std::vector<double>&,
                        std::int64_t, BalanceRow&);
#endif

} // namespace tread::decomp
