#pragma once

#include <optional>

#include "decomp/grid_halo.hpp"
#include "kernels/mpm/grid/grid.hpp"
#include "kernels/mpm/grid/seams.hpp"
#include "kernels/mpm/grid/wall_pages.hpp"
#include "kernels/mpm/pages/order.hpp"
#include "world/world.hpp"

namespace tread::solver
{

/// Grid of the sand: geometry, walls and seams, and what P2G and the update of nodes write in a step.
template<class Exec, class Real>
struct SandGrid
{
    SandGrid(const Exec& exec, const scene::Scene& scene, const world::World& world);

    mpm::PagesView view(const mpm::Pages<Exec>& pages) const
    {
        return pages.view(geometry.lattice(), geometry.refinement.levels);
    }

    mpm::GridGeometry                     geometry;
    mpm::GridWalls                        walls;
    Vec3<Real>                            gravity;    ///< m/s2
    Real                                  mass_floor; ///< kg; lighter nodes are held
    mpm::WallPages<Exec, Real>            wall_pages;
    std::optional<mpm::Seams<Exec, Real>> seams;  ///< only on a refined grid
    Array<Exec, Real>                     tiles;  ///< [point pages][mpm::node_channels][mpm::tile_nodes]
    Array<Exec, Real>                     motion; ///< [node pages][mpm::motion_channels][mpm::page_cells]
};

/// Calls launch(pages, list) with the lattice and the point pages of each level of the grid.
template<class Exec, class Real, class Launch>
void for_each_level(const SandGrid<Exec, Real>& grid, const mpm::PagesView& pages, const Launch& launch)
{
    if (!grid.seams)
    {
        launch(pages, mpm::all_point_pages(pages));
        return;
    }
    for (int level = 0; level <= grid.geometry.refinement.levels; ++level)
    {
        launch(mpm::on_level(pages, grid.geometry.refinement, level), grid.seams->point_pages(level));
    }
}

/// Allocates what a step writes, and lists wall pages and seams; call when the pages have been rebuilt.
template<class Exec, class Real>
void follow_pages(const Exec& exec, SandGrid<Exec, Real>& grid, const mpm::PagesView& pages,
                  SortScratch<Exec>& scratch);

/// P2G on one rank.
template<class Exec, class Real>
void points_to_grid(const Exec& exec, SandGrid<Exec, Real>& grid, const mpm::PointsView<Real>& points,
                    const mpm::PagesView& pages);

/// P2G on several ranks, collective: border pages go first and travel while the others are scattered.
template<class Exec, class Real>
void points_to_shared_grid(const Exec& exec, SandGrid<Exec, Real>& grid, const mpm::PointsView<Real>& points,
                           const mpm::PagesView& pages, decomp::GridHalo<Exec, Real>& halo);

/// Constants of a step of dt (s) with local damping (0 = none).
template<class Exec, class Real>
mpm::GridStep<Real> grid_step(const SandGrid<Exec, Real>& grid, double dt, double damping)
{
    return {static_cast<Real>(dt), grid.gravity, static_cast<Real>(damping), grid.mass_floor, grid.walls};
}

/// Updates the nodes' velocities, walls included, and adds the step to `tallies`. `shared`: totals of the nodes that
/// ranks share.
template<class Exec, class Real>
void update_nodes(const Exec& exec, SandGrid<Exec, Real>& grid, const mpm::PagesView& pages,
                  const mpm::SharedPagesView<Real>& shared, const mpm::GridStep<Real>& step, double* tallies);

} // namespace tread::solver
