#include "solver/sand/sand_grid.hpp"

#include "backend/instantiate.hpp"
#include "kernels/mpm/transfers/scatter.hpp"

namespace tread::solver
{
namespace
{

/// Nodes below this mass are held. The share of the lightest point's mass only keeps products of weights clear of
/// underflow in fp32: a larger one would hold nodes that move with the sand, and strain sand in free fall.
constexpr double mass_floor_share = 1e-20;

} // namespace

template<class Exec, class Real>
SandGrid<Exec, Real>::SandGrid(const Exec& exec, const scene::Scene& scene, const world::World& world)
    : geometry(world.geometry)
    , walls(world.grid_walls)
    , gravity(Vec3<double>(scene.domain.gravity[0], scene.domain.gravity[1], scene.domain.gravity[2]).cast<Real>())
    , mass_floor(static_cast<Real>(mass_floor_share * world::least_mass(world.sand)))
    , wall_pages(exec)
    , tiles(exec, "tiles")
    , motion(exec, "grid motion")
{
    if (geometry.refinement.levels > 0) { seams.emplace(exec); }
}

template<class Exec, class Real>
void follow_pages(const Exec& exec, SandGrid<Exec, Real>& grid, const mpm::PagesView& pages, SortScratch<Exec>& scratch)
{
    grid.tiles.resize(pages.point_pages * mpm::node_channels * mpm::tile_nodes);
    grid.motion.resize(pages.node_pages * mpm::motion_channels * mpm::page_cells);
    if (grid.seams) { mpm::list_seams(exec, pages, grid.geometry.refinement, *grid.seams, scratch); }
    if (mpm::has_walls(grid.walls)) { mpm::list_wall_pages(exec, pages, grid.walls, grid.wall_pages, scratch); }
}

template<class Exec, class Real>
void points_to_grid(const Exec& exec, SandGrid<Exec, Real>& grid, const mpm::PointsView<Real>& points,
                    const mpm::PagesView& pages)
{
    for_each_level(grid, pages,
                   [&](const mpm::PagesView& of_level, const mpm::PageList& list)
                   { mpm::scatter(exec, points, of_level, list, grid.tiles.data()); });
    if (grid.seams) { mpm::hand_down(exec, pages, grid.geometry.refinement, grid.tiles.data(), *grid.seams); }
}

template<class Exec, class Real>
void points_to_shared_grid(const Exec& exec, SandGrid<Exec, Real>& grid, const mpm::PointsView<Real>& points,
                           const mpm::PagesView& pages, decomp::GridHalo<Exec, Real>& halo)
{
    const auto scatter_pages = [&](const Exec& stream, const mpm::PageList& list)
    { mpm::scatter(stream, points, pages, list, grid.tiles.data()); };
    halo.begin(pages, grid.tiles.data(), scatter_pages);
    scatter_pages(exec, halo.interior());
}

template<class Exec, class Real>
void update_nodes(const Exec& exec, SandGrid<Exec, Real>& grid, const mpm::PagesView& pages,
                  const mpm::SharedPagesView<Real>& shared, const mpm::GridStep<Real>& step, double* tallies)
{
    mpm::update_grid(exec, pages, grid.wall_pages.view(), grid.seams ? grid.seams->view() : shared, grid.tiles.data(),
                     step, grid.motion.data(), tallies);
    mpm::update_walls(exec, pages, grid.wall_pages.view(), step, grid.motion.data(), tallies);
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template struct SandGrid<Exec, Real>;                                                                              \
    template void follow_pages(const Exec&, SandGrid<Exec, Real>&, const mpm::PagesView&, SortScratch<Exec>&);         \
    template void points_to_grid(const Exec&, SandGrid<Exec, Real>&, const mpm::PointsView<Real>&,                     \
                                 const mpm::PagesView&);                                                               \
    template void points_to_shared_grid(const Exec&, SandGrid<Exec, Real>&, const mpm::PointsView<Real>&,              \
                                        const mpm::PagesView&, decomp::GridHalo<Exec, Real>&);                         \
    template void update_nodes(const Exec&, SandGrid<Exec, Real>&, const mpm::PagesView&,                              \
                               const mpm::SharedPagesView<Real>&, const mpm::GridStep<Real>&, double*)
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
