#include "decomp/balance.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "backend/instantiate.hpp"
#include "decomp/halo_plan.hpp"
#include "decomp/partition.hpp"

namespace tread::decomp
{
namespace
{

/// Cost of migrating a point, in steps of a point: packing, sending, unpacking, sorting and rebuilding what depends on
/// it.
constexpr double move_cost = 20;

/// Cost of a partition, in steps of all points of a rank, whatever moves: METIS takes about a microsecond for a page of
/// some 500 points, on every rank, beside the sorting of all points.
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

/// Pages of all ranks with their loads, and the rank with most load on each.
struct AllPages
{
    PageGraph graph;
    PageRanks present;
};

AllPages gather_pages(const Communicator& communicator, const PageLoads& own)
{
    PageKeys            own_key;
    std::vector<double> own_load;
    for (const auto& [key, load] : own)
    {
        own_key.push_back(key);
        own_load.push_back(load);
    }
    const PageKeys            keys  = communicator.gather(own_key);
    const std::vector<double> loads = communicator.gather(own_load);
    const PageRanks           ranks = communicator.gather(PageRanks(own.size(), communicator.rank()));

    std::vector<std::size_t> order(keys.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return keys[a] < keys[b]; });
    PageKeys            key;
    std::vector<double> load;
    PageRanks           present;
    double              most = 0;
    for (const std::size_t i : order)
    {
        if (key.empty() || keys[i] != key.back())
        {
            key.push_back(keys[i]);
            load.push_back(0);
            present.push_back(ranks[i]);
            most = loads[i];
        }
        load.back() += loads[i];
        if (loads[i] <= most) { continue; }
        most           = loads[i];
        present.back() = ranks[i];
    }
    return {page_graph(std::move(key), std::move(load)), std::move(present)};
}

/// New owners, of which as many as possible are those that have most load on a page now.
PageRanks new_owners(const Communicator& communicator, const AllPages& pages)
{
    PartitionOptions options;
    options.ranks         = communicator.size();
    const Partition parts = make_partition(communicator, pages.graph, options);
    return stay_put(parts.rank, pages.present, pages.graph.load, options.ranks);
}

double moved_between(const AllPages& pages, const PageRanks& to)
{
    double moved = 0;
    for (std::size_t page = 0; page < to.size(); ++page)
    {
        if (to[page] != pages.present[page]) { moved += pages.graph.load[page]; }
    }
    return moved;
}

} // namespace

double imbalance_of(const std::vector<double>& loads)
{
    const double middle = mean(loads);
    return middle > 0 ? largest(loads) / middle : 1;
}

std::vector<double> BalanceRule::felt(std::vector<double> loads) const
{
    for (double& load : loads) { load = std::max(load, least_); }
    return loads;
}

bool BalanceRule::is_due(const std::vector<double>& loads, std::int64_t steps) const
{
    const std::vector<double> all = felt(loads);
    return imbalance_of(all) > threshold_ &&
           (largest(all) - mean(all)) * static_cast<double>(steps) > partition_cost * mean(all);
}

bool BalanceRule::is_worth(const std::vector<double>& now, const std::vector<double>& after, double moved,
                           std::int64_t steps) const
{
    const double gain = (largest(felt(now)) - largest(felt(after))) * static_cast<double>(steps);
    return gain > partition_cost * mean(now) + move_cost * moved / static_cast<double>(now.size());
}

template<class Exec>
Balance<Exec>::Balance(Decomposition<Exec>& decomposition, const BalanceRule& rule)
    : decomposition_(decomposition)
    , rule_(rule)
{
}

template<class Exec>
bool Balance<Exec>::is_due(std::int64_t step) const
{
    return !state_.row.loads.empty() && step >= state_.not_before &&
           rule_.is_due(state_.row.loads, step - state_.partitioned);
}

/// If it does not pay, it is tried again after twice as many steps.
template<class Exec>
bool Balance<Exec>::repartition(const PageLoads& own, std::int64_t step)
{
    const AllPages            pages = gather_pages(decomposition_.communicator, own);
    const PageRanks           ranks = new_owners(decomposition_.communicator, pages);
    const std::vector<double> after = loads_of(pages.graph, ranks, decomposition_.ranks());
    if (!rule_.is_worth(state_.row.loads, after, moved_between(pages, ranks), step - state_.partitioned))
    {
        state_.not_before = 2 * step - state_.partitioned;
        return false;
    }
    assign(pages.graph.key, ranks, step);
    return true;
}

template<class Exec>
void Balance<Exec>::repartition_anew(const PageLoads& own, std::int64_t step)
{
    const AllPages pages = gather_pages(decomposition_.communicator, own);
    if (pages.graph.key.empty()) { return; }
    assign(pages.graph.key, new_owners(decomposition_.communicator, pages), step);
}

template<class Exec>
void Balance<Exec>::assign(const std::vector<std::uint64_t>& pages, const PageRanks& ranks, std::int64_t step)
{
    decomposition_.owners.assign(pages, ranks);
    state_.partitioned = step;
    ++state_.row.repartitions;
}

template<class Exec>
void Balance<Exec>::note(double load, std::int64_t points_moved)
{
    state_.row.loads     = decomposition_.communicator.gather(load);
    state_.row.imbalance = imbalance_of(state_.row.loads);
    state_.row.points_moved += points_moved;
}

#define TREAD_INSTANTIATE(Exec) template class Balance<Exec>
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::decomp
