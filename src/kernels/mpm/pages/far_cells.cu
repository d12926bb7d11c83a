#include "backend/instantiate.hpp"
#include "backend/launch.cuh"
#include "kernels/mpm/pages/far_cells_impl.hpp"

namespace tread::mpm
{

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template void mark_far_cells(const Exec&, Pages<Exec>&, const PageOwnersView&, std::int32_t)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::mpm
