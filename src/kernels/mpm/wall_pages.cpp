#include "kernels/mpm/wall_pages.hpp"

#include "backend/launch.hpp"
#include "kernels/mpm/wall_pages_impl.hpp"

namespace tread::mpm
{

template void list_wall_pages(const Cpu&, const PagesView&, const GridWalls&, Array<Cpu, std::int32_t>&,
                              Array<Cpu, std::int32_t>&, SortScratch<Cpu>&);

} // namespace tread::mpm
