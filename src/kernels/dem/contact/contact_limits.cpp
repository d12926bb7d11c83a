#include "backend/launch.hpp"
#include "kernels/dem/contact/contact_limits_impl.hpp"

namespace tread::dem
{

void expect_contacts(const Cpu& cpu, Pairs<Cpu>& pairs, const BodiesView& bodies, const BodyLaw& law,
                     const Vec3<double>& gravity, double dt, const SharedView& shared)
{
    const auto each = [&](std::int64_t count)
    {
        return [&cpu, count](const char* name, const auto& item)
        { for_each(cpu, name, count, [=](std::int64_t i) { item(i, OneLane{}); }); };
    };
    contact_limits::expect(cpu, pairs, bodies, law, gravity, dt, shared, each(pairs.key.size()), each(bodies.count));
}

} // namespace tread::dem
