#include "kernels/mpm/grid/wall_pages.hpp"

#include "backend/launch.hpp"
#include "kernels/mpm/grid/wall_pages_impl.hpp"

namespace tread::mpm
{

template void list_wall_pages(const Cpu&, const PagesView&, const GridWalls&, WallPages<Cpu, float>&,
                              SortScratch<Cpu>&);
template void list_wall_pages(const Cpu&, const PagesView&, const GridWalls&, WallPages<Cpu, double>&,
                              SortScratch<Cpu>&);

} // namespace tread::mpm
