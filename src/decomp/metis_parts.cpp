#include <fmt/format.h>
#include <metis.h>

#include "base/errors.hpp"
#include "decomp/partition.hpp"

namespace tread::decomp
{

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
    options[METIS_OPTION_CONTIG] = 0; // contiguous parts fail on disconnected graphs, such as separate heaps of sand
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
