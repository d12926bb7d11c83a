#pragma once

#include "backend/array.hpp"
#include "kernels/mpm/laws/material_parameters.hpp"
#include "kernels/mpm/pages/pages.hpp"
#include "kernels/mpm/points.hpp"

namespace tread::mpm
{

/// How cells' means are smoothed to reach a length, and how often.
struct Smoothing
{
    int          passes;   ///< each exchanges strain between neighbouring cells
    double       share;    ///< of the difference from a neighbour that a pass takes, at most an eighth
    std::int64_t interval; ///< steps from one mean to the next
};

/// Makes the smoothing whose weights have the standard deviation `length` along each axis, in cells; from 1 on. Means
/// of cells and interpolation between their centres have a variance of a quarter; a pass adds twice its share. In the
/// interval no wave crosses the length: a step carries none further than a cell.
Smoothing make_smoothing(double length);

/// Cells' values of average_strain.
template<class Exec, class Real>
struct MeanStrain
{
    MeanStrain(const Exec& exec, const Smoothing& how)
        : smoothing(how)
        , mass(exec, "cell mass of mean strain")
        , strain(exec, "cell mean strain")
        , smoothed(exec, "cell mean strain smoothed")
    {
    }

    void resize(std::int64_t cells)
    {
        mass.resize(cells);
        strain.resize(cells);
        smoothed.resize(cells);
    }

    Smoothing         smoothing;
    Array<Exec, Real> mass;     ///< kg, [point pages][page_cells], of nonlocal materials
    Array<Exec, Real> strain;   ///< likewise, log volume ratio
    Array<Exec, Real> smoothed; ///< likewise, scratch
};

/// Computes PointsView::mean_strain of the points of nonlocal materials (Bolton::nonlocal_weight): the mean of the
/// skeleton's log volume ratio over such points around, weighted by mass and a bell curve. Cells take means of their
/// points; passes exchange strain between neighbours in proportion to the smaller mass of the two, which keeps the
/// mass-weighted mean of all cells and moves nothing across empty ones; points interpolate between cells. A constant
/// field is reproduced exactly.
template<class Exec, class Real>
void average_strain(const Exec&, const PointsView<Real>& points, const PagesView& pages,
                    const MaterialParameters<Real>* materials, MeanStrain<Exec, Real>& cells);

} // namespace tread::mpm
