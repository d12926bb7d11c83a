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
    const MaterialParameters<Real>* materials; ///< by PointsView::material
    Real                            pic;       ///< share of the grid's velocity in the points', rest FLIP; 1 = APIC
    /// 1/s, of average_divergence: the laws' volumetric strain rate; null = the point's own.
    const Real* cell_divergence;
};

/// Per page, fp64: what the points' update did in a step.
enum PointSum : int
{
    point_kinetic,       ///< J, after the step
    point_strain,        ///< J, elastic, after the step
    point_plastic_work,  ///< J, of the step
    point_contact_work,  ///< J, of the step's contact forces on the sand
    point_stress_power,  ///< W, of the stress after the step on its rate of strain, at the positions after it
    point_contact_power, ///< W, of the step's contact forces on the velocity after P2G
    point_sums
};

/// Per page, fp64, largest since they were cleared.
enum PointPeak : int
{
    peak_speed_squared, ///< m2/s2
    peak_cell_change,   ///< the largest CellChange of a point
    point_peaks
};

/// G2P of the points of the listed pages: velocity (FLIP with PIC part, APIC, AFLIP), position, stress and plastic
/// state; for coupled scenes also the interpolated grid velocity and the support acceleration. Books the step in the
/// page's tally of PointSum, and in peaks[point page][PointPeak]; `moves`: where every point is now.
template<class Real>
void gather(const Cpu&, const PointsView<Real>& points, const PagesView& pages, const PageList& list,
            const Real* motion, const GatherStep<Real>& step, const MovesView& moves, double* tallies, double* peaks);
template<class Real>
void gather(const Gpu&, const PointsView<Real>& points, const PagesView& pages, const PageList& list,
            const Real* motion, const GatherStep<Real>& step, const MovesView& moves, double* tallies, double* peaks);

} // namespace tread::mpm
