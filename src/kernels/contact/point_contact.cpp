#include "backend/launch.hpp"
#include "kernels/contact/contact_loops.hpp"
#include "kernels/contact/point_contact_impl.hpp"

namespace tread::contact
{

template void begin_step(const Cpu&, PointContact<Cpu>&, const mpm::PointsView<float>&, const mpm::PagesView&,
                         const dem::BodiesView&, const PointBodyLaw&, const SearchReach&);
template void begin_step(const Cpu&, PointContact<Cpu>&, const mpm::PointsView<double>&, const mpm::PagesView&,
                         const dem::BodiesView&, const PointBodyLaw&, const SearchReach&);
template void begin_kept_step(const Cpu&, PointContact<Cpu>&, const mpm::PointsView<float>&, const PointBodyLaw&);
template void begin_kept_step(const Cpu&, PointContact<Cpu>&, const mpm::PointsView<double>&, const PointBodyLaw&);
template void substep(const Cpu&, PointContact<Cpu>&, const dem::BodiesView&, const PointBodyLaw&, double);
template void finish_step(const Cpu&, PointContact<Cpu>&, const mpm::PointsView<float>&, double);
template void finish_step(const Cpu&, PointContact<Cpu>&, const mpm::PointsView<double>&, double);
template void resume_candidates(const Cpu&, PointContact<Cpu>&, const dem::BodiesView&, const PointBodyLaw&);
template void keep_history(const Cpu&, PointContact<Cpu>&);
template void follow_rows(const Cpu&, PointContact<Cpu>&, const Array<Cpu, std::int32_t>&, const dem::BodiesView&);
template const Summary* summarise(const Cpu&, PointContact<Cpu>&, std::int64_t);

} // namespace tread::contact
