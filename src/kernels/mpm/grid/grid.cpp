#include "kernels/mpm/grid/grid.hpp"

#include "backend/instantiate.hpp"
#include "backend/launch.hpp"
#include "kernels/mpm/grid/wall_step_kern.hpp"

namespace tread::mpm
{

template<class Exec, class Real>
void update_grid(const Exec& cpu, const PagesView& pages, const WallPagesView<Real>& wall_pages,
                 const SharedPagesView<Real>& shared_pages, const Real* tiles, const GridStep<Real>& step, Real* motion,
                 double* tallies)
{
    const auto update_page = [=](std::int64_t page)
    {
        const Index3       at             = page_coordinates(pages.node_page_key[page]);
        const std::int32_t wall_page      = wall_pages.number(page);
        const std::int32_t shared_page    = shared_pages.number(page);
        double             sum[grid_sums] = {};
        Real*              here           = motion + page * motion_channels * page_cells;
        std::int32_t       tile_pages[octants];
        for (int octant = 0; octant < octants; ++octant) { tile_pages[octant] = tile_page(pages, page, octant); }
        for (int place = 0; place < page_cells; ++place)
        {
            Real channels[node_channels];
            if (shared_page < 0) { sum_tiles(tile_pages, tiles, place, channels); }
            else { read_total(shared_pages, shared_page, place, channels); }
            if (wall_page < 0) { write_motion(update_free_node(step, channels, sum), here + place); }
            else
            {
                WallNode<Real>& node = wall_pages.node[std::int64_t(wall_page) * page_cells + place];
                write_motion(update_node(step, node_at(at, place), channels, node, sum), here + place);
            }
        }
        for (int s = 0; s < grid_sums; ++s)
        {
            add_to_new_step(tallies + page * tally_width(grid_sums), grid_sums, s, sum[s]);
        }
    };
    for_each_heavy(cpu, "update grid", pages.node_pages, update_page);
}

template<class Exec, class Real>
void update_walls(const Exec& cpu, const PagesView& pages, const WallPagesView<Real>& wall_pages,
                  const GridStep<Real>& step, Real* motion, double* tallies)
{
    const auto update_page = [=](std::int64_t number)
    {
        const std::int64_t page   = wall_pages.page[number];
        const Index3       at     = page_coordinates(pages.node_page_key[page]);
        const WallRegion   region = wall_region(step.walls, at);
        WallNode<Real>     nodes[wall_region_nodes];
        double             sum[grid_sums] = {};
        for (int item = 0; item < region.nodes; ++item)
        {
            nodes[item] = wall_node(wall_pages, number, region_node(region, item));
        }
        for (int axis = 0; axis < 3; ++axis)
        {
            for (int end = 0; region.paired[axis] && end < 2; ++end)
            {
                const int plane = wall_plane(step.walls, at, region, axis, end);
                for (int item = 0; plane != no_plane && item < region.nodes >> region.bits[axis]; ++item)
                {
                    hold_group(step.walls, region, axis, end, plane, item, nodes, sum);
                }
            }
        }
        Real* here = motion + page * motion_channels * page_cells;
        for (int place = 0; place < page_cells; ++place)
        {
            finish_wall_node(step, nodes[region_item(region, place)], here + place, sum);
        }
        double* row = tallies + page * tally_width(grid_sums);
        for (int s = 0; s < grid_sums; ++s) { add_to_same_step(row, grid_sums, s, sum[s]); }
    };
    for_each_heavy(cpu, "update walls", wall_pages.count, update_page);
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void update_grid(const Exec&, const PagesView&, const WallPagesView<Real>&, const SharedPagesView<Real>&, \
                              const Real*, const GridStep<Real>&, Real*, double*);                                     \
    template void update_walls(const Exec&, const PagesView&, const WallPagesView<Real>&, const GridStep<Real>&,       \
                               Real*, double*)
TREAD_FOR_THIS_BACKEND_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::mpm
