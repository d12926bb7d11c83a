#include "kernels/mpm/wall_pages.hpp"

#include "backend/launch.cuh"
#include "kernels/mpm/wall_pages_impl.hpp"

namespace tread::mpm
{

template void list_wall_pages(const Gpu&, const PagesView&, const GridWalls&, WallPages<Gpu, float>&,
                              SortScratch<Gpu>&);
template void list_wall_pages(const Gpu&, const PagesView&, const GridWalls&, WallPages<Gpu, double>&,
                              SortScratch<Gpu>&);

} // namespace tread::mpm
