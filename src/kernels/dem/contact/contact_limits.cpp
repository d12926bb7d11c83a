#include "backend/instantiate.hpp"
#include "backend/launch.hpp"
#include "kernels/dem/contact/contact_limits_impl.hpp"

namespace tread::dem
{

template<class Exec>
void expect_contacts(const Exec& cpu, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law,
                     const Vec3<double>& gravity, double dt, const SharedView& shared)
{
    const auto each = [&](std::int64_t count, const std::int32_t* list)
    {
        return [&cpu, count, list](const char* name, const auto& item)
        { for_each(cpu, name, count, [=](std::int64_t i) { item(list == nullptr ? i : list[i], OneLane{}); }); };
    };
    contact_limits::expect(cpu, pairs, bodies, law, gravity, dt, shared, each(pairs.key.size(), nullptr),
                           each(pairs.sleep.listed(bodies.count), pairs.sleep.list()));
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template void expect_contacts(const Exec&, Pairs<Exec>&, const BodiesView&, const BodyLaw&, const Vec3<double>&,   \
                                  double, const SharedView&)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::dem
