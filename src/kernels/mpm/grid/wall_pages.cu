#include "kernels/mpm/grid/wall_pages.hpp"

#include "backend/launch.cuh"
#include "kernels/mpm/grid/wall_pages_impl.hpp"

namespace tread::mpm
{

template void list_wall_pages(const Gpu&, const PagesView&, const GridWalls&, WallPages<Gpu, float>&,
                              SortScratch<Gpu>&);
template void list_wall_pages(const Gpu&, const PagesView&, const GridWalls&, WallPages<Gpu, double>&,
                              SortScratch<Gpu>&);

} // namespace tread::mpm
