#pragma once

#include "backend/sort.hpp"
#include "kernels/mpm/grid/walls.hpp"

namespace tread::mpm
{

/// Lists the node pages of which walls may hold nodes, and makes room for those. `scratch` is kept between calls.
template<class Exec, class Real>
void list_wall_pages(const Exec& exec, const PagesView& pages, const GridWalls& walls,
                     WallPages<Exec, Real>& wall_pages, SortScratch<Exec>& scratch);

} // namespace tread::mpm
