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
        const bool walls = has_held_nodes(step.walls, at);
        for (int place = 0; place < page_cells; ++place)
        {
            Real channels[node_channels];
            sum_tiles(tile_pages, tiles, place, channels);
            if (walls) { update_node(step, node_at(at, place), channels, here + place, sum); }
            else { update_free_node(step, node_at(at, place), channels, here + place, sum); }
        }
        for (int s = 0; s < grid_sums; ++s) { book(tallies + page * tally_width(grid_sums), grid_sums, s, sum[s]); }
    };
    for_each_heavy(cpu, "update grid", pages.node_pages, update_page);
}

namespace
{

/// Calls f(home page, sums of the step) for every page of a list and books more in its tally.
template<class F>
void for_each_wall_page(const Cpu& cpu, const char* name, const PagesView& pages, const PageList& wall_pages,
                        double* tallies, F f)
{
    const auto item = [=](std::int64_t i)
    {
        const std::int64_t page           = wall_pages.page[i];
        double             sum[grid_sums] = {};
        f(HomePage{page_coordinates(pages.node_page_key[page]), page}, sum);
        for (int s = 0; s < grid_sums; ++s)
        {
            book_more(tallies + page * tally_width(grid_sums), grid_sums, s, sum[s]);
        }
    };
    for_each_heavy(cpu, name, wall_pages.count, item);
}

} // namespace

template<class Real>
void update_walls(const Cpu& cpu, const PagesView& pages, const PageList& wall_pages, const Real* tiles,
                  const GridStep<Real>& step, Real* motion, double* tallies)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        if (!has_walls(step.walls, axis)) { continue; }
        const auto hold_page = [=](const HomePage& home, double* sum)
        {
            for (int place = 0; place < page_cells; ++place)
            {
                hold_group(pages, home, step.walls, node_at(home.at, place), axis, motion, sum);
            }
        };
        for_each_wall_page(cpu, "hold walls", pages, wall_pages, tallies, hold_page);
    }
    const auto finish_page = [=](const HomePage& home, double* sum)
    {
        std::int32_t tile_pages[octants];
        for (int octant = 0; octant < octants; ++octant) { tile_pages[octant] = tile_page(pages, home.number, octant); }
        for (int place = 0; place < page_cells; ++place)
        {
            const Index3 node = node_at(home.at, place);
            finish_held(tile_pages, tiles, step, node, motion_of(motion, home.number, node), sum);
        }
    };
    for_each_wall_page(cpu, "finish walls", pages, wall_pages, tallies, finish_page);
}

template void update_grid(const Cpu&, const PagesView&, const float*, const GridStep<float>&, float*, double*);
template void update_grid(const Cpu&, const PagesView&, const double*, const GridStep<double>&, double*, double*);
template void update_walls(const Cpu&, const PagesView&, const PageList&, const float*, const GridStep<float>&, float*,
                           double*);
template void update_walls(const Cpu&, const PagesView&, const PageList&, const double*, const GridStep<double>&,
                           double*, double*);

} // namespace tread::mpm
