#include "backend/launch.hpp"
#include "kernels/dem/pairs/resume_list_impl.hpp"

namespace tread::dem
{

double largest_in_grid(std::vector<double> radii)
{
    if (radii.empty()) { return 0; }
    constexpr double much_larger = 4;
    const auto       middle      = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
    std::nth_element(radii.begin(), middle, radii.end());
    return much_larger * *middle;
}

template void classify_bodies(const Cpu&, Pairs<Cpu>&, const BodiesView&, const TemplateView*, double);
template void list_large_bodies(const Cpu&, Pairs<Cpu>&);
template void stage_bodies(const Cpu&, Pairs<Cpu>&, const BodiesView&);
template void begin_list(const Cpu&, Pairs<Cpu>&, const BodiesView&, const BodyLaw&);
template void share_speeds(const Cpu&, Pairs<Cpu>&, const BodiesView&, const BodyLaw&, const SharedView&);
template void request_displacement(const Cpu&, Pairs<Cpu>&, const BodiesView&, const BodyLaw&, double, double,
                                   const SharedView&);
template void allow_displacement(const Cpu&, Pairs<Cpu>&, const BodiesView&, const BodyLaw&, double, double,
                                 std::int64_t);
template void list_pairs(const Cpu&, Pairs<Cpu>&, const BodiesView&, const BodyLaw&);
template void resume_list(const Cpu&, Pairs<Cpu>&, const BodiesView&);
template void find_pairs(const Cpu&, Pairs<Cpu>&, const BodiesView&, const BodyLaw&, double, double, double);

} // namespace tread::dem
