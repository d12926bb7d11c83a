#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include <fmt/format.h>
#include <metis.h>

#include "base/errors.hpp"
#include "decomp/partition.hpp"

namespace tread::decomp
{
namespace
{

/// A page that weighs more than its rank's share has a rank of its own, whatever it weighs: the share of the others.
double most_that_counts(std::vector<double> load, int ranks)
{
    std::sort(load.begin(), load.end(), std::greater<>());
    double rest = std::accumulate(load.begin(), load.end(), 0.0);
    int    own  = 0;
    while (own < ranks - 1 && load[static_cast<std::size_t>(own)] * (ranks - own) > rest)
    {
        rest -= load[static_cast<std::size_t>(own)];
        ++own;
    }
    return rest / (ranks - own);
}

/// METIS counts in 32-bit integers, gives nothing to vertices without weight, and leaves ranks empty where a vertex
/// outweighs what a rank should get.
std::vector<idx_t> whole_loads(const std::vector<double>& load, int ranks)
{
    constexpr double most_in_all = 1 << 30;
    const double     most        = most_that_counts(load, ranks);
    const auto       counted     = [most](double sum, double value) { return sum + std::min(value, most); };
    const double     total       = std::accumulate(load.begin(), load.end(), 0.0, counted);
    const double     unit        = total > 0 ? (most_in_all - static_cast<double>(load.size())) / total : 0.0;

    std::vector<idx_t> whole;
    whole.reserve(load.size());
    for (const double value : load)
    {
        whole.push_back(1 + static_cast<idx_t>(std::floor(unit * std::min(value, most))));
    }
    return whole;
}

} // namespace

PageRanks metis_parts(const PageGraph& graph, int ranks, double imbalance)
{
    idx_t              vertices = static_cast<idx_t>(graph.pages()), constraints = 1, parts = ranks, cut = 0;
    std::vector<idx_t> first(graph.first.begin(), graph.first.end());
    std::vector<idx_t> neighbour(graph.neighbour.begin(), graph.neighbour.end());
    std::vector<idx_t> shared(graph.shared.begin(), graph.shared.end());
    std::vector<idx_t> load    = whole_loads(graph.load, ranks);
    real_t             balance = static_cast<real_t>(imbalance);
    idx_t              options[METIS_NOPTIONS];
    METIS_SetDefaultOptions(options);
    options[METIS_OPTION_SEED]   = 1;
    options[METIS_OPTION_CONTIG] = 0; // it fails on graphs that are not connected, as heaps of sand apart are not
    PageRanks rank(graph.pages());
    const int done = METIS_PartGraphKway(&vertices, &constraints, first.data(), neighbour.data(), load.data(), nullptr,
                                         shared.data(), &parts, nullptr, &balance, options, &cut, rank.data());
    if (done != METIS_OK)
    {
        throw EnvironmentError(
            fmt::format("METIS could not partition {} pages into {} ranks (error {})", vertices, ranks, done));
    }
    return rank;
}

} // namespace tread::decomp
