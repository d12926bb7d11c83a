#include "kernels/mpm/scatter.hpp"

#include "backend/launch.hpp"
#include "kernels/mpm/scatter_kern.hpp"

namespace tread::mpm
{
namespace
{

template<class Real>
void scatter_page(const PointsView<Real>& points, const PagesView& pages, std::int64_t page, Real* out)
{
    if (pages.first_point[page] == pages.first_point[page + 1]) { return; }
    Real         tile[tile_nodes][lanes] = {};
    const Real   spacing                 = static_cast<Real>(pages.spacing);
    const Index3 low                     = page_coordinates(pages.point_page_key[page]);
    for (std::int64_t at = pages.first_point[page]; at < pages.first_point[page + 1]; ++at)
    {
        const std::int64_t i       = pages.point_at[at];
        const auto         load    = point_load(points, i);
        const Index3       cell    = node_at(low, pages.place_at[at]);
        const auto         stencil = stencil_above<Real>(cell, points.position.get(i), pages.inverse_spacing,
                                                 pages.inverse_spacing, pages.stencil_shift);
        Real(*base)[lanes]         = tile + tile_base(stencil.base);
        for (int c = 0; c < 3; ++c)
        {
            for (int b = 0; b < 3; ++b)
            {
                for (int a = 0; a < 3; ++a)
                {
                    Real share[lanes];
                    node_share(load, stencil, spacing, a, b, c, share);
                    Real* node = base[tile_offset(a, b, c)];
                    for (int l = 0; l < lanes; ++l) { node[l] += share[l]; }
                }
            }
        }
    }
    for (int node = 0; node < tile_nodes; ++node)
    {
        const TileSlot slot = tile_slot(node % tile_edge, node / tile_edge % tile_edge, node / (tile_edge * tile_edge));
        for (int channel = 0; channel < node_channels; ++channel)
        {
            out[slot.first + channel * slot.stride] = tile[node][channel];
        }
    }
}

} // namespace

template<class Real>
void scatter(const Cpu& cpu, const PointsView<Real>& points, const PagesView& pages, Real* tiles)
{
    for_each_heavy(cpu, "scatter", pages.point_pages,
                   [=](std::int64_t page)
                   { scatter_page(points, pages, page, tiles + page * node_channels * tile_nodes); });
}

template void scatter(const Cpu&, const PointsView<float>&, const PagesView&, float*);
template void scatter(const Cpu&, const PointsView<double>&, const PagesView&, double*);

} // namespace tread::mpm
