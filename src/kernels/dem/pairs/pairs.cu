#include "backend/launch.cuh"
#include "kernels/dem/pairs/resume_list_impl.hpp"

namespace tread::dem
{

template void classify_bodies(const Gpu&, Pairs<Gpu>&, const BodiesView&, const TemplateView*, double);
template void list_large_bodies(const Gpu&, Pairs<Gpu>&);
template void stage_bodies(const Gpu&, Pairs<Gpu>&, const BodiesView&);
template void begin_list(const Gpu&, Pairs<Gpu>&, const BodiesView&, const BodyLaw&);
template void share_speeds(const Gpu&, Pairs<Gpu>&, const BodiesView&, const BodyLaw&, const SharedView&);
template void request_displacement(const Gpu&, Pairs<Gpu>&, const BodiesView&, const BodyLaw&, double, double,
                                   const SharedView&);
template void allow_displacement(const Gpu&, Pairs<Gpu>&, const BodiesView&, const BodyLaw&, double, double,
                                 std::int64_t);
template void list_pairs(const Gpu&, Pairs<Gpu>&, const BodiesView&, const BodyLaw&);
template void resume_list(const Gpu&, Pairs<Gpu>&, const BodiesView&);
template void find_pairs(const Gpu&, Pairs<Gpu>&, const BodiesView&, const BodyLaw&, double, double, double);

} // namespace tread::dem
