#pragma once

#include "backend/sort.hpp"
#include "kernels/mpm/grid.hpp"

namespace tread::mpm
{

/// Lists the node pages whose nodes walls hold together with others (numbers in the list of node pages, ascending).
/// `marks` and `scratch` are kept between calls.
template<class Exec>
void list_wall_pages(const Exec& exec, const PagesView& pages, const GridWalls& walls, Array<Exec, std::int32_t>& list,
                     Array<Exec, std::int32_t>& marks, SortScratch<Exec>& scratch);

} // namespace tread::mpm
