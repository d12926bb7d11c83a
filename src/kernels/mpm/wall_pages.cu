#include "kernels/mpm/wall_pages.hpp"

#include "backend/launch.cuh"
#include "kernels/mpm/wall_pages_impl.hpp"

namespace tread::mpm
{

template void list_wall_pages(const Gpu&, const PagesView&, const GridWalls&, Array<Gpu, std::int32_t>&,
                              Array<Gpu, std::int32_t>&, SortScratch<Gpu>&);

} // namespace tread::mpm
