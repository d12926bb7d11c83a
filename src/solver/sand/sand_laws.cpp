#include "solver/sand/sand_laws.hpp"

#include "backend/instantiate.hpp"
#include "kernels/mpm/transfers/cell_stress.hpp"
#include "world/materials.hpp"

namespace tread::solver
{

template<class Exec, class Real>
CellMeans<Exec, Real>::CellMeans(const Exec& exec)
    : divergence(exec, "cell divergence")
    , stress(exec, "point stress of cell pressure")
{
}

template<class Exec, class Real>
SandLaws<Exec, Real>::SandLaws(const Exec& exec, const scene::Scene& scene, const world::World& world)
    : materials(exec, "materials")
    , pic_rate(world::pic_rate(scene, world.sand))
{
    materials.assign(world::law_parameters<Real>(scene));
    if (scene.numerics.volume_strain == scene::VolumeStrain::cell_average) { cell_means.emplace(exec); }
    if (const double length = scene::softening_length(scene); length > 0)
    {
        mean_strain.emplace(exec, mpm::make_smoothing(length / scene.grid.spacing));
    }
}

template<class Exec, class Real>
void resize_cell_means(SandLaws<Exec, Real>& laws, const mpm::Points<Exec, Real>& points, const mpm::Pages<Exec>& pages)
{
    const std::int64_t cells = pages.point_page_key.size() * mpm::page_cells;
    if (laws.mean_strain) { laws.mean_strain->resize(cells); }
    if (!laws.cell_means) { return; }
    laws.cell_means->divergence.resize(cells);
    laws.cell_means->stress.resize(points.stress.size());
}

template<class Exec, class Real>
mpm::PointsView<Real> points_of_scatter(const Exec& exec, SandLaws<Exec, Real>& laws, mpm::Points<Exec, Real>& points,
                                        const mpm::PagesView& pages)
{
    mpm::PointsView<Real> view = points.view();
    if (!laws.cell_means) { return view; }
    const Planes<Real, 6> shared{laws.cell_means->stress.data(), points.stride};
    mpm::share_pressure(exec, view, pages, shared);
    view.stress = shared;
    return view;
}

template<class Exec, class Real>
mpm::GatherStep<Real> gather_step(const SandLaws<Exec, Real>& laws, double dt)
{
    return {static_cast<Real>(dt), laws.materials.data(), static_cast<Real>(world::pic_share(laws.pic_rate, dt)),
            laws.cell_means ? laws.cell_means->divergence.data() : nullptr};
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template struct CellMeans<Exec, Real>;                                                                             \
    template struct SandLaws<Exec, Real>;                                                                              \
    template void resize_cell_means(SandLaws<Exec, Real>&, const mpm::Points<Exec, Real>&, const mpm::Pages<Exec>&);   \
    template mpm::PointsView<Real> points_of_scatter(const Exec&, SandLaws<Exec, Real>&, mpm::Points<Exec, Real>&,     \
                                                     const mpm::PagesView&);                                           \
    template mpm::GatherStep<Real> gather_step(const SandLaws<Exec, Real>&, double)
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
