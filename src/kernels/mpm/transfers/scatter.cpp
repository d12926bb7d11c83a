#include "kernels/mpm/transfers/scatter.hpp"

#include <type_traits>

#include "backend/instantiate.hpp"
#include "backend/launch.hpp"
#include "backend/quad.hpp"
#include "kernels/mpm/transfers/scatter_kern.hpp"

namespace tread::mpm
{
namespace
{

/// Tag: not an affine transfer (APIC, AFLIP); a point's momentum per weight is the same at every node.
struct WithoutAffine
{
};
struct WithAffine
{
};

/// Contributions to a tile node: mass and momentum; force and padding.
template<class Real>
struct TileNode
{
    Quad<Real> inertia, force;
};

/// A point's load in registers.
template<class Real>
struct Burden
{
    Quad<Real> inertia, per_offset[3]; ///< per_offset: affine transfers (APIC, AFLIP) only
    Quad<Real> force, per_slope[3];
};

template<class Real>
Burden<Real> burden(const PointLoad<Real>& load)
{
    const auto   low  = [](const Real* v) { return Quad<Real>{{v[0], v[1], v[2], v[3]}}; };
    const auto   high = [](const Real* v) { return Quad<Real>{{v[4], v[5], v[6], v[7]}}; };
    Burden<Real> quads{low(load.value), {}, high(load.value), {}};
    for (int axis = 0; axis < 3; ++axis)
    {
        quads.per_offset[axis] = low(load.per_offset[axis]);
        quads.per_slope[axis]  = high(load.per_slope[axis]);
    }
    return quads;
}

/// Returns the offset of node n of a stencil from its point along an axis, m.
template<class Real>
Real offset(const Stencil<Real>& s, int axis, int n, Real spacing)
{
    return (Real(n) - s.fraction[axis]) * spacing;
}

/// Adds a point's load to the nodes of its stencil, axis by axis: common factors of a layer or a row of nodes are
/// multiplied once.
template<class Real, class Affine>
void add_load(const Burden<Real>& load, const Stencil<Real>& s, Real spacing, TileNode<Real>* lowest, Affine)
{
    constexpr bool affine = std::is_same_v<Affine, WithAffine>;
    for (int c = 0; c < 3; ++c)
    {
        const Real wz    = s.weight[2][c];
        Quad<Real> layer = load.inertia, force = wz * load.force;
        if (affine) { add_scaled(offset(s, 2, c, spacing), load.per_offset[2], layer); }
        layer = wz * layer;
        add_scaled(s.slope[2][c], load.per_slope[2], force);
        const Quad<Real> layer_by_y = wz * load.per_offset[1], layer_by_x = wz * load.per_offset[0];
        const Quad<Real> force_by_y = wz * load.per_slope[1], force_by_x = wz * load.per_slope[0];
        for (int b = 0; b < 3; ++b)
        {
            const Real wy  = s.weight[1][b];
            Quad<Real> row = layer, row_force = wy * force;
            if (affine) { add_scaled(offset(s, 1, b, spacing), layer_by_y, row); }
            row = wy * row;
            add_scaled(s.slope[1][b], force_by_y, row_force);
            const Quad<Real> row_by_x = wy * layer_by_x, row_force_by_x = wy * force_by_x;
            for (int a = 0; a < 3; ++a)
            {
                const Real      wx   = s.weight[0][a];
                TileNode<Real>& node = lowest[tile_offset(a, b, c)];
                add_scaled(wx, row, node.inertia);
                if (affine) { add_scaled(offset(s, 0, a, spacing) * wx, row_by_x, node.inertia); }
                add_scaled(wx, row_force, node.force);
                add_scaled(s.slope[0][a], row_force_by_x, node.force);
            }
        }
    }
}

/// Stores a tile in the layout that the grid reads.
template<class Real>
void store_tile(const TileNode<Real>* tile, Real* out)
{
    for (int node = 0; node < tile_nodes; ++node)
    {
        const TileSlot slot = tile_slot(node % tile_edge, node / tile_edge % tile_edge, node / (tile_edge * tile_edge));
        Real*          to   = out + slot.first;
        for (int c = 0; c < 4; ++c) { to[c * slot.stride] = tile[node].inertia[c]; }
        for (int c = 4; c < node_channels; ++c) { to[c * slot.stride] = tile[node].force[c - 4]; }
    }
}

template<class Real, class Affine>
void scatter_page(const PointsView<Real>& points, const PagesView& pages, std::int64_t page, Real* out, Affine)
{
    if (pages.first_point[page] == pages.first_point[page + 1]) { return; }
    TileNode<Real> tile[tile_nodes] = {};
    const Real     spacing          = static_cast<Real>(pages.spacing);
    const Index3   low              = page_coordinates(pages.point_page_key[page]);
    for (std::int64_t at = pages.first_point[page]; at < pages.first_point[page + 1]; ++at)
    {
        const std::int64_t i       = pages.point_at[at];
        const Index3       cell    = node_at(low, pages.place_at[at]);
        const auto         stencil = stencil_above<Real>(cell, points.position.get(i), pages.inverse_spacing, pages);
        add_load(burden(point_load(points, i)), stencil, spacing, tile + tile_base(stencil.base), Affine{});
    }
    store_tile(tile, out);
}

} // namespace

template<class Exec, class Real>
void scatter(const Exec& cpu, const PointsView<Real>& points, const PagesView& pages, const PageList& list, Real* tiles)
{
    const auto launch = [&](auto affine)
    {
        const auto scatter_one = [=](std::int64_t i)
        {
            const std::int64_t page = list.at(i);
            scatter_page(points, pages, page, tiles + page * node_channels * tile_nodes, affine);
        };
        for_each_heavy(cpu, "scatter", list.count, scatter_one);
    };
    if (points.affine.data != nullptr) { launch(WithAffine{}); }
    else { launch(WithoutAffine{}); }
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void scatter(const Exec&, const PointsView<Real>&, const PagesView&, const PageList&, Real*)
TREAD_FOR_THIS_BACKEND_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::mpm
