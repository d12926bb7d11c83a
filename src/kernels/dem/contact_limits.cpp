#include "backend/launch.hpp"
#include "kernels/dem/contact_limits_impl.hpp"

namespace tread::dem
{

void expect_contacts(const Cpu& cpu, Pairs<Cpu>& pairs, const BodiesView& bodies, const BodyLaw& law,
                     const Vec3<double>& gravity, double dt)
{
    const AnticipatePair   anticipate    = contact_limits::anticipate(pairs, bodies, law, gravity, dt);
    constexpr std::int64_t worth_threads = 512; // as for the contacts themselves
    for_each_heavy(
        cpu, "anticipated contacts", pairs.key.size(), [=](std::int64_t p) { anticipate(p); }, worth_threads);
    contact_limits::add_up(cpu, pairs, bodies, law);
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
