#pragma once

#include "backend/array.hpp"
#include "kernels/mpm/pages/page_list.hpp"
#include "kernels/mpm/points.hpp"

namespace tread::mpm
{

/// P2G: computes the tile of every listed page that holds points, tiles[page][channel][tile node] (channels:
/// scatter_kern.hpp). Each page sums its points in their order: the sums do not depend on threads or on which pages are
/// listed.
template<class Exec, class Real>
void scatter(const Exec&, const PointsView<Real>& points, const PagesView& pages, const PageList& list, Real* tiles);

} // namespace tread::mpm
