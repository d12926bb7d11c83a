#include "kernels/mpm/transfers/gather.hpp"

#include <algorithm>

#include "backend/instantiate.hpp"
#include "backend/launch.hpp"
#include "backend/quad.hpp"
#include "kernels/mpm/transfers/gather_kern.hpp"

namespace tread::mpm
{
namespace
{

template<class Real>
using Tile = NodeMotion<Quad<Real>>[tile_nodes];

template<class Real>
void load_tile(const Real* motion, const std::int32_t* neighbours, Tile<Real>& tile)
{
    for (int node = 0; node < tile_nodes; ++node)
    {
        const Real* source = tile_source(motion, neighbours, node);
        for (int c = 0; c < 3; ++c)
        {
            tile[node].velocity.set(c, source[c * page_cells]);
            tile[node].change.set(c, source[(3 + c) * page_cells]);
        }
    }
}

/// Interpolates the motion, all components at a time; node(a, b, c) returns the NodeMotion of a node of the stencil.
template<class Real, class Node, class Moment>
Seen<Real> see(const Stencil<Real>& s, Real spacing, Node node, Moment)
{
    const auto sum = sum_motion(s, node, Moment{});
    Seen<Real> seen{};
    for (int i = 0; i < 3; ++i) { set_seen(seen, i, sum, i, s, spacing, Moment{}); }
    return seen;
}

template<class Real, class Moment>
void gather_page(const PointsView<Real>& points, const PagesView& pages, const Real* motion,
                 const GatherStep<Real>& step, const MovesView& moves, std::int64_t page, double* tally, double* peaks,
                 Moment)
{
    std::int32_t* count = moves.count + page * move_counts;
    std::fill(count, count + move_counts, 0);
    if (pages.first_point[page] == pages.first_point[page + 1])
    {
        std::fill(tally + point_sums, tally + tally_width(point_sums), 0.0);
        return;
    }
    Tile<Real> tile = {};
    load_tile(motion, pages.node_page_of + 8 * page, tile);
    const Index3 low              = page_coordinates(pages.point_page_key[page]);
    const Real   spacing          = static_cast<Real>(pages.spacing);
    double       sums[point_sums] = {};
    for (std::int64_t at = pages.first_point[page]; at < pages.first_point[page + 1]; ++at)
    {
        const std::int64_t i       = pages.point_at[at];
        const Index3       cell    = node_at(low, pages.place_at[at]);
        const auto         point   = read_point(points, i);
        const auto         stencil = stencil_above<Real>(cell, point.position, pages.inverse_spacing, pages);
        const auto*        lowest  = tile + tile_base(stencil.base);
        const auto         nodes   = [=](int a, int b, int c) -> const NodeMotion<Quad<Real>>&
        { return lowest[tile_offset(a, b, c)]; };
        const auto seen = see(stencil, spacing, nodes, Moment{});
        const Move move = update_point(points, i, point, seen, stencil.base, pages, page, step, sums, peaks);
        moves.to[at]    = packed(move);
        count[move.direction] += move.direction != own_page;
        count[changed_points] += move.cell_change != CellChange::none;
    }
    if (count[changed_points] > 0)
    {
#pragma omp atomic write
        *moves.changed_in = moves.step;
    }
    for (int s = 0; s < point_sums; ++s) { add_to_new_step(tally, point_sums, s, sums[s]); }
}

} // namespace

template<class Exec, class Real>
void gather(const Exec& cpu, const PointsView<Real>& points, const PagesView& pages, const PageList& list,
            const Real* motion, const GatherStep<Real>& step, const MovesView& moves, double* tallies, double* peaks)
{
    const auto launch = [&](auto moment)
    {
        const auto item = [=](std::int64_t i)
        {
            const std::int64_t page = list.at(i);
            gather_page(points, pages, motion, step, moves, page, tallies + page * tally_width(point_sums),
                        peaks + page * point_peaks, moment);
        };
        for_each_heavy(cpu, "gather", list.count, item);
    };
    if (points.affine.data != nullptr) { launch(WithMoment{}); }
    else { launch(WithoutMoment{}); }
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void gather(const Exec&, const PointsView<Real>&, const PagesView&, const PageList&, const Real*,         \
                         const GatherStep<Real>&, const MovesView&, double*, double*)
TREAD_FOR_THIS_BACKEND_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::mpm
