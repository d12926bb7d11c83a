#include "kernels/mpm/grid.hpp"

#include "backend/launch.hpp"
#include "kernels/mpm/wall_step_kern.hpp"

namespace tread::mpm
{

template<class Real>
void update_grid(const Cpu& cpu, const PagesView& pages, const Real* tiles, const GridStep<Real>& step, Real* motion,
                 double* tallies)
{
    const auto update_page = [=](std::int64_t page)
    {
        const Index3 at             = page_coordinates(pages.node_page_key[page]);
        double       sum[grid_sums] = {};
        Real*        here           = motion + page * motion_channels * page_cells;
        std::int32_t tile_pages[octants];
        for (int octant = 0; octant < octants; ++octant) { tile_pages[octant] = tile_page(pages, page, octant); }
        for (int place = 0; place < page_cells; ++place)
        {
            Real channels[node_channels];
            sum_tiles(tile_pages, tiles, place, channels);
            update_node(step, node_at(at, place), channels, here + place, sum);
        }
        for (int s = 0; s < grid_sums; ++s) { book(tallies + page * tally_width(grid_sums), grid_sums, s, sum[s]); }
    };
    for_each_heavy(cpu, "update grid", pages.node_pages, update_page);
}

template<class Real>
void update_walls(const Cpu& cpu, const PagesView& pages, const Real* tiles, const GridStep<Real>& step, Real* motion,
                  double* tallies)
{
    const auto update_page = [=](std::int64_t page)
    {
        const Index3 at = page_coordinates(pages.node_page_key[page]);
        if (!touches_wall(step.walls, at)) { return; }
        double sum[grid_sums] = {};
        for (int place = 0; place < page_cells; ++place)
        {
            const Index3 node = node_at(at, place);
            if (!owns_pairs(step.walls, node)) { continue; }
            update_owned(pages, {at, page}, tiles, step, node, motion, sum);
        }
        for (int s = 0; s < grid_sums; ++s)
        {
            book_more(tallies + page * tally_width(grid_sums), grid_sums, s, sum[s]);
        }
    };
    for_each_heavy(cpu, "update walls", pages.node_pages, update_page);
}

template void update_grid(const Cpu&, const PagesView&, const float*, const GridStep<float>&, float*, double*);
template void update_grid(const Cpu&, const PagesView&, const double*, const GridStep<double>&, double*, double*);
template void update_walls(const Cpu&, const PagesView&, const float*, const GridStep<float>&, float*, double*);
template void update_walls(const Cpu&, const PagesView&, const double*, const GridStep<double>&, double*, double*);

} // namespace tread::mpm
