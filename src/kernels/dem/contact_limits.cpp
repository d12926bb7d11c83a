#include "backend/launch.hpp"
#include "kernels/dem/contact_limits_impl.hpp"

namespace tread::dem
{

void expect_contacts(const Cpu& cpu, Pairs<Cpu>& pairs, const BodiesView& bodies, const BodyLaw& law,
                     const Vec3<double>& gravity, double dt)
{
    contact_limits::expect(cpu, pairs, bodies, law, gravity, dt);
}

double smallest_contact_time(const Cpu& cpu, Pairs<Cpu>& pairs, const BodiesView& bodies)
{
    return contact_limits::contact_time(cpu, pairs, bodies);
}

double largest_overlap(const Cpu& cpu, Pairs<Cpu>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    return contact_limits::overlap(cpu, pairs, bodies, law);
}

} // namespace tread::dem
