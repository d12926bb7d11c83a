#pragma once

#include "backend/array.hpp"
#include "kernels/mpm/pages/page_list.hpp"
#include "kernels/mpm/points.hpp"

namespace tread::mpm
{

/// P2G: writes the tile of every listed page that holds points, tiles[page][channel][tile node] (scatter_kern.hpp names
/// the channels). Each page adds its points in their order: the sums do not depend on threads, nor on what is listed.
template<class Real>
void scatter(const Cpu&, const PointsView<Real>& points, const PagesView& pages, const PageList& list, Real* tiles);
template<class Real>
void scatter(const Gpu&, const PointsView<Real>& points, const PagesView& pages, const PageList& list, Real* tiles);

} // namespace tread::mpm
