#include "decomp/page_graph.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "kernels/mpm/pages/page_key.hpp"

namespace tread::decomp
{
namespace
{

struct Step
{
    mpm::Index3  to;
    std::int32_t shared; ///< nodes
};

/// Steps to the 26 neighbours. Stencils of two pages that are neighbours along an axis share two layers of nodes along
/// it, and all layers along the other axes.
std::array<Step, 26> steps()
{
    std::array<Step, 26> all{};
    std::size_t          next = 0;
    for (std::int32_t z = -1; z <= 1; ++z)
    {
        for (std::int32_t y = -1; y <= 1; ++y)
        {
            for (std::int32_t x = -1; x <= 1; ++x)
            {
                if (x == 0 && y == 0 && z == 0) { continue; }
                const auto layers = [](std::int32_t step)
                { return step == 0 ? mpm::tile_edge : mpm::tile_edge - mpm::page_edge; };
                all[next++] = {{x, y, z}, layers(x) * layers(y) * layers(z)};
            }
        }
    }
    return all;
}

} // namespace

PageGraph page_graph(std::vector<std::uint64_t> key, std::vector<double> load)
{
    PageGraph  graph{std::move(key), std::move(load), {0}, {}, {}};
    const auto around = steps();
    for (const std::uint64_t page : graph.key)
    {
        const mpm::Index3 at = mpm::page_coordinates(page);
        for (const Step& step : around)
        {
            const std::uint64_t other = mpm::page_key({at.x + step.to.x, at.y + step.to.y, at.z + step.to.z});
            const auto          found = std::lower_bound(graph.key.begin(), graph.key.end(), other);
            if (found == graph.key.end() || *found != other) { continue; }
            graph.neighbour.push_back(static_cast<std::int32_t>(found - graph.key.begin()));
            graph.shared.push_back(step.shared);
        }
        graph.first.push_back(static_cast<std::int64_t>(graph.neighbour.size()));
    }
    return graph;
}

} // namespace tread::decomp
