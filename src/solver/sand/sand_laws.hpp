#pragma once

#include <optional>

#include "kernels/mpm/laws/material_parameters.hpp"
#include "kernels/mpm/transfers/gather.hpp"
#include "kernels/mpm/transfers/mean_strain.hpp"
#include "world/world.hpp"

namespace tread::solver
{

/// Cell averages of volumetric strain rate and of pressure.
template<class Exec, class Real>
struct CellMeans
{
    explicit CellMeans(const Exec& exec);

    Array<Exec, Real> divergence; ///< [point pages][mpm::page_cells], 1/s
    Array<Exec, Real> stress;     ///< [6][points], Pa, with the cells' mean pressure
};

/// Material laws of the sand: their parameters, and how the grid's motion becomes velocity and strain of the points.
template<class Exec, class Real>
struct SandLaws
{
    SandLaws(const Exec& exec, const scene::Scene& scene, const world::World& world);

    Array<Exec, mpm::MaterialParameters<Real>> materials;   ///< indexed by PointsView::material
    double                                     pic_rate;    ///< 1/s, world::pic_rate
    std::optional<CellMeans<Exec, Real>>       cell_means;  ///< only with cell-average volumetric strain
    std::optional<mpm::MeanStrain<Exec, Real>> mean_strain; ///< only with a softening length
};

/// Allocates the cells' values, if there are any.
template<class Exec, class Real>
void resize_cell_means(SandLaws<Exec, Real>& laws, const mpm::Points<Exec, Real>& points,
                       const mpm::Pages<Exec>& pages);

/// Returns the points whose stress P2G uses; computes the cells' mean pressure, if the laws have cell averages.
template<class Exec, class Real>
mpm::PointsView<Real> points_of_scatter(const Exec& exec, SandLaws<Exec, Real>& laws, mpm::Points<Exec, Real>& points,
                                        const mpm::PagesView& pages);

/// Constants of G2P in a step of dt (s).
template<class Exec, class Real>
mpm::GatherStep<Real> gather_step(const SandLaws<Exec, Real>& laws, double dt);

} // namespace tread::solver
