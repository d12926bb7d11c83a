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

void expect_shared_contacts(const Cpu& cpu, Pairs<Cpu>& pairs, const SharedView& shared)
{
    contact_limits::expect_of_all_ranks(cpu, pairs, shared);
}

double smallest_contact_time(const Cpu& cpu, Pairs<Cpu>& pairs, const BodiesView& bodies)
{
    return contact_limits::contact_time(cpu, pairs, bodies);
}

const double* largest_overlap(const Cpu& cpu, Pairs<Cpu>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    return contact_limits::overlap(cpu, pairs, bodies, law);
}

} // namespace tread::dem
