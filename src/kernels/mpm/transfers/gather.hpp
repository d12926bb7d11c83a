#pragma once

#include "backend/array.hpp"
#include "kernels/mpm/grid/grid.hpp"
#include "kernels/mpm/laws/material_parameters.hpp"
#include "kernels/mpm/pages/moves.hpp"
#include "kernels/mpm/pages/page_list.hpp"
#include "kernels/mpm/pages/pages.hpp"
#include "kernels/mpm/points.hpp"
#include "kernels/mpm/tally.hpp"

namespace tread::mpm
{

template<class Real>
struct GatherStep
{
    Real                            dt;        ///< s
    const MaterialParameters<Real>* materials; ///< indexed by PointsView::material
    Real                            pic;       ///< PIC share of the points' velocity update, rest FLIP; 1 = APIC
    /// 1/s, from average_divergence: volumetric strain rate for the laws; null = the point's own.
    const Real* cell_divergence;
};

/// Sums per page, fp64, of the points' update in a step.
enum PointSum : int
{
    point_kinetic,       ///< J, after the step
    point_strain,        ///< J, elastic, after the step
    point_plastic_work,  ///< J, of the step
    point_contact_work,  ///< J, of the step's contact forces on the sand
    point_stress_power,  ///< W, of the stress after the step on its strain rate, at the positions after the step
    point_contact_power, ///< W, of the step's contact forces on the velocity after P2G
    point_sums
};

/// Maxima per page, fp64, since they were cleared.
enum PointPeak : int
{
    peak_speed_squared, ///< m2/s2
    peak_cell_change,   ///< maximum CellChange of the points
    point_peaks
};

/// G2P of the points of the listed pages: velocity (FLIP with PIC part, APIC, AFLIP), position, stress and plastic
/// state; for coupled scenes also the interpolated grid velocity and the support acceleration. Adds the step to the
/// page's tally of PointSum and updates peaks[point page][PointPeak]; `moves` receives the new place of every point.
template<class Exec, class Real>
void gather(const Exec&, const PointsView<Real>& points, const PagesView& pages, const PageList& list,
            const Real* motion, const GatherStep<Real>& step, const MovesView& moves, double* tallies, double* peaks);

} // namespace tread::mpm
