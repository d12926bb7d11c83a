#include "backend/launch.cuh"
#include "kernels/contact/candidates_impl.hpp"

namespace tread::contact
{

template void find_candidates(const Gpu&, Candidates<Gpu>&, const mpm::PointsView<float>&, const mpm::PagesView&,
                              const dem::BodiesView&, const dem::TemplateView*, const dem::PairTable&, RadiusRule,
                              const SearchReach&);
template void find_candidates(const Gpu&, Candidates<Gpu>&, const mpm::PointsView<double>&, const mpm::PagesView&,
                              const dem::BodiesView&, const dem::TemplateView*, const dem::PairTable&, RadiusRule,
                              const SearchReach&);
template void order_by_point(const Gpu&, Candidates<Gpu>&);

} // namespace tread::contact
