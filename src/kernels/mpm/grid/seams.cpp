#include "backend/launch.hpp"
#include "kernels/mpm/grid/seams_impl.hpp"

namespace tread::mpm
{

template<class Real>
void hand_down(const Cpu& cpu, const PagesView& pages, const Refinement& refinement, const Real* tiles,
               Seams<Cpu, Real>& seams)
{
    hand_down_all(cpu, pages, refinement, tiles, seams);
}

template<class Real>
void follow_coarser(const Cpu& cpu, const PagesView& pages, const Refinement& refinement, const Seams<Cpu, Real>& seams,
                    Real* motion)
{
    follow_all(cpu, pages, refinement, seams, motion);
}

template void list_seams(const Cpu&, const PagesView&, const Refinement&, Seams<Cpu, float>&, SortScratch<Cpu>&);
template void list_seams(const Cpu&, const PagesView&, const Refinement&, Seams<Cpu, double>&, SortScratch<Cpu>&);
template void hand_down(const Cpu&, const PagesView&, const Refinement&, const float*, Seams<Cpu, float>&);
template void hand_down(const Cpu&, const PagesView&, const Refinement&, const double*, Seams<Cpu, double>&);
template void follow_coarser(const Cpu&, const PagesView&, const Refinement&, const Seams<Cpu, float>&, float*);
template void follow_coarser(const Cpu&, const PagesView&, const Refinement&, const Seams<Cpu, double>&, double*);

} // namespace tread::mpm
