#include "backend/launch.cuh"
#include "kernels/contact/contact_loops.cuh"
#include "kernels/contact/point_contact_impl.hpp"

namespace tread::contact
{

template void begin_step(const Gpu&, PointContact<Gpu>&, const mpm::PointsView<float>&, const mpm::PagesView&,
                         const dem::BodiesView&, const PointBodyLaw&, const SearchReach&);
template void begin_step(const Gpu&, PointContact<Gpu>&, const mpm::PointsView<double>&, const mpm::PagesView&,
                         const dem::BodiesView&, const PointBodyLaw&, const SearchReach&);
template void begin_kept_step(const Gpu&, PointContact<Gpu>&, const mpm::PointsView<float>&, const PointBodyLaw&);
template void begin_kept_step(const Gpu&, PointContact<Gpu>&, const mpm::PointsView<double>&, const PointBodyLaw&);
template void substep(const Gpu&, PointContact<Gpu>&, const dem::BodiesView&, const PointBodyLaw&, double);
template void finish_step(const Gpu&, PointContact<Gpu>&, const mpm::PointsView<float>&, double);
template void finish_step(const Gpu&, PointContact<Gpu>&, const mpm::PointsView<double>&, double);
template void resume_candidates(const Gpu&, PointContact<Gpu>&, const dem::BodiesView&, const PointBodyLaw&);
template void keep_history(const Gpu&, PointContact<Gpu>&);
template void follow_rows(const Gpu&, PointContact<Gpu>&, const Array<Gpu, std::int32_t>&, const dem::BodiesView&);
template const Summary* summarise(const Gpu&, PointContact<Gpu>&, std::int64_t);

} // namespace tread::contact
