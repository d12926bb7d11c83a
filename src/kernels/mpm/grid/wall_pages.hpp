#pragma once

#include "backend/sort.hpp"
#include "kernels/mpm/grid/walls.hpp"

namespace tread::mpm
{

/// Lists the node pages in which walls may constrain nodes, and allocates their nodes. `scratch` is kept between calls.
template<class Exec, class Real>
void list_wall_pages(const Exec& exec, const PagesView& pages, const GridWalls& walls,
                     WallPages<Exec, Real>& wall_pages, SortScratch<Exec>& scratch);

} // namespace tread::mpm
