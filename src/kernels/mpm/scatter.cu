#include "kernels/mpm/scatter.hpp"

#include "backend/launch.cuh"
#include "kernels/mpm/grid_kern.hpp"
#include "kernels/mpm/scatter_kern.hpp"

namespace tread::mpm
{
namespace
{

/// A thread for each cell of a page and each of the three layers of nodes, low to high, that the cell's stencils reach.
constexpr int layers          = 3;
constexpr int scatter_threads = layers * page_cells;

/// Nodes that all cells of a page reach in one layer.
constexpr int layer_nodes = tile_edge * tile_edge * page_edge;

/// Without APIC a point's momentum does not vary over its stencil.
struct PlainMomentum
{
};
struct AffineMomentum
{
};

/// What the nine nodes of one layer of one cell receive, kept in registers over all points of the cell.
template<class Real>
struct LayerSums
{
    Real at[9][node_channels];
};

/// Adds one point. Weights are products over the axes: what is common to a row of nodes is formed once.
template<class Real, class Momentum>
__device__ void add_point(const PointLoad<Real>& load, const Stencil<Real>& s, int layer, Real spacing,
                          LayerSums<Real>& sums, Momentum)
{
    const Real wz = layer == 0 ? s.weight[2][0] : layer == 1 ? s.weight[2][1] : s.weight[2][2];
    const Real sz = layer == 0 ? s.slope[2][0] : layer == 1 ? s.slope[2][1] : s.slope[2][2];
    const Real oz = (Real(layer) - s.fraction[2]) * spacing;
#pragma unroll
    for (int b = 0; b < 3; ++b)
    {
        const Real plane = wz * s.weight[1][b], by_y = wz * s.slope[1][b], by_z = sz * s.weight[1][b];
        const Real oy = (Real(b) - s.fraction[1]) * spacing;
#pragma unroll
        for (int c = 0; c < node_channels; ++c)
        {
            const bool moving = std::is_same_v<Momentum, AffineMomentum> && c >= 1 && c <= 3;
            Real       value  = plane * load.value[c];
            if (moving) { value += plane * (oy * load.per_offset[1][c] + oz * load.per_offset[2][c]); }
            if (c >= 4) { value += by_y * load.per_slope[1][c] + by_z * load.per_slope[2][c]; }
#pragma unroll
            for (int a = 0; a < 3; ++a)
            {
                Real share = s.weight[0][a] * value;
                if (c >= 4) { share += s.slope[0][a] * (plane * load.per_slope[0][c]); }
                if (moving)
                {
                    share += s.weight[0][a] * ((Real(a) - s.fraction[0]) * spacing * plane * load.per_offset[0][c]);
                }
                sums.at[3 * b + a][c] += share;
            }
        }
    }
}

/// One block a page. The nine rounds of a layer hit nine different nodes for each cell, and no two cells of a layer the
/// same node in one round: plain additions in a fixed order, no atomics (design: the GPU's measured facts).
template<class Real, class Momentum>
struct ScatterPage
{
    PointsView<Real> points;
    PagesView        pages;
    Real*            tiles;

    __device__ void operator()(std::int64_t page) const
    {
        if (pages.first_point[page] == pages.first_point[page + 1]) { return; }
        __shared__ Real tile[layers][node_channels][layer_nodes];
        Real*           flat = &tile[0][0][0];
        for (int n = threadIdx.x; n < layers * node_channels * layer_nodes; n += scatter_threads) { flat[n] = 0; }

        const int             place = static_cast<int>(threadIdx.x) % page_cells;
        const int             layer = static_cast<int>(threadIdx.x) / page_cells;
        const LayerSums<Real> sums  = sum_cell(page, place, layer);
        const int             base  = tile_offset(place & 3, place >> 2 & 3, place >> 4);
#pragma unroll
        for (int node = 0; node < 9; ++node)
        {
            __syncthreads();
            for (int c = 0; c < node_channels; ++c)
            {
                tile[layer][c][base + tile_offset(node % 3, node / 3, 0)] += sums.at[node][c];
            }
        }
        __syncthreads();
        write(tile, tiles + page * node_channels * tile_nodes);
    }

    __device__ LayerSums<Real> sum_cell(std::int64_t page, int place, int layer) const
    {
        LayerSums<Real>    sums{};
        const Index3       base    = node_at(page_coordinates(pages.point_page_key[page]), place);
        const Real         spacing = static_cast<Real>(pages.spacing);
        const std::int64_t cell    = page * page_cells + place;
        const std::int64_t end     = pages.cell_first_point[cell + 1];
        for (std::int64_t at = pages.cell_first_point[cell]; at < end; ++at)
        {
            const std::int64_t i    = pages.point_at[at];
            const auto         load = point_load(points, i);
            const auto stencil = stencil_above<Real>(base, points.position.get(i), pages.spacing, pages.stencil_shift);
            add_point(load, stencil, layer, spacing, sums, Momentum{});
        }
        return sums;
    }

    /// A node of the tile is the lowest layer of the cells at its height, the middle one of those below, and so on.
    __device__ static void write(const Real (&tile)[layers][node_channels][layer_nodes], Real* out)
    {
        for (int n = threadIdx.x; n < node_channels * tile_nodes; n += scatter_threads)
        {
            const int channel = n / tile_nodes, node = n % tile_nodes;
            const int z   = node / (tile_edge * tile_edge);
            Real      sum = 0;
            for (int layer = 0; layer < layers; ++layer)
            {
                const bool reaches = z >= layer && z - layer < page_edge;
                if (reaches) { sum += tile[layer][channel][node - layer * tile_edge * tile_edge]; }
            }
            out[n] = sum;
        }
    }
};

} // namespace

// Other shapes of this kernel, on an H200 with 4e6 points, 8 and 1 a cell: one thread a cell, 27 rounds a point, 7.3e9
// and 4.1e9 points/s; this one 10.5e9 and 3.3e9; its registers capped for three blocks an SM 9.1e9 and 3.7e9; momentum
// and force on separate threads 8.8e9 and 2.9e9.
template<class Real>
void scatter(const Gpu& gpu, const PointsView<Real>& points, const PagesView& pages, Real* tiles)
{
    const auto launch = [&](auto momentum)
    {
        for_each_block<scatter_threads>(gpu, "scatter", pages.point_pages,
                                        ScatterPage<Real, decltype(momentum)>{points, pages, tiles});
    };
    if (points.affine.data != nullptr) { launch(AffineMomentum{}); }
    else { launch(PlainMomentum{}); }
}

template void scatter(const Gpu&, const PointsView<float>&, const PagesView&, float*);
template void scatter(const Gpu&, const PointsView<double>&, const PagesView&, double*);

} // namespace tread::mpm
