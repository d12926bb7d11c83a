#include "backend/launch.cuh"
#include "kernels/mpm/grid/seams_impl.hpp"

namespace tread::mpm
{

template<class Real>
void hand_down(const Gpu& gpu, const PagesView& pages, const Refinement& refinement, const Real* tiles,
               Seams<Gpu, Real>& seams)
{
    hand_down_all(gpu, pages, refinement, tiles, seams);
}

template<class Real>
void follow_coarser(const Gpu& gpu, const PagesView& pages, const Refinement& refinement, const Seams<Gpu, Real>& seams,
                    Real* motion)
{
    follow_all(gpu, pages, refinement, seams, motion);
}

template void list_seams(const Gpu&, const PagesView&, const Refinement&, Seams<Gpu, float>&, SortScratch<Gpu>&);
template void list_seams(const Gpu&, const PagesView&, const Refinement&, Seams<Gpu, double>&, SortScratch<Gpu>&);
template void hand_down(const Gpu&, const PagesView&, const Refinement&, const float*, Seams<Gpu, float>&);
template void hand_down(const Gpu&, const PagesView&, const Refinement&, const double*, Seams<Gpu, double>&);
template void follow_coarser(const Gpu&, const PagesView&, const Refinement&, const Seams<Gpu, float>&, float*);
template void follow_coarser(const Gpu&, const PagesView&, const Refinement&, const Seams<Gpu, double>&, double*);

} // namespace tread::mpm
