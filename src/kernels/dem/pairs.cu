#include "backend/launch.cuh"
#include "kernels/dem/pairs_impl.hpp"

namespace tread::dem
{

template void classify_bodies(const Gpu&, Pairs<Gpu>&, const BodiesView&, const TemplateView*);
template void stage_bodies(const Gpu&, Pairs<Gpu>&, const BodiesView&);
template void want_travel(const Gpu&, Pairs<Gpu>&, const BodiesView&, const BodyLaw&, double);
template void grant_travel(const Gpu&, Pairs<Gpu>&, const BodiesView&, const BodyLaw&, double);
template void list_pairs(const Gpu&, Pairs<Gpu>&, const BodiesView&, const BodyLaw&);
template void find_pairs(const Gpu&, Pairs<Gpu>&, const BodiesView&, const BodyLaw&, double);

} // namespace tread::dem
