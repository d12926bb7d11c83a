#pragma once

#include <cmath>

#include "kernels/mpm/transfers/mean_strain_kern.hpp"

// average_strain for both backends; mean_strain.cpp and mean_strain.cu provide for_each and instantiate.
namespace tread::mpm
{

template<class Exec, class Real>
void average_strain(const Exec& exec, const PointsView<Real>& points, const PagesView& pages,
                    const MaterialParameters<Real>* materials, MeanStrain<Exec, Real>& cells)
{
    const std::int64_t count = pages.point_pages * page_cells;
    const auto         view  = [&] { return CellStrains<Real>{cells.mass.data(), cells.strain.data()}; };
    for_each(exec, "cell strain", count, TakeCellStrain<Real>{points, pages, materials, view()});
    for (int pass = 0; pass < cells.smoothing.passes; ++pass)
    {
        for_each(
            exec, "smooth cell strain", count,
            SmoothCellStrain<Real>{pages, view(), static_cast<Real>(cells.smoothing.share), cells.smoothed.data()});
        cells.strain.swap(cells.smoothed);
    }
    for_each(exec, "mean strain of points", count, GiveMeanStrain<Real>{points, pages, materials, view()});
}

} // namespace tread::mpm
