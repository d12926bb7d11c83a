#include "backend/launch.cuh"
#include "kernels/dem/contact_limits_impl.hpp"
#include "kernels/dem/warp_lanes.cuh"

namespace tread::dem
{

void expect_contacts(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law,
                     const Vec3<double>& gravity, double dt)
{
    constexpr int lanes = 8; // as for the contacts themselves
    for_each_group<lanes>(gpu, "anticipated contacts", pairs.key.size(),
                          contact_limits::anticipate(pairs, bodies, law, gravity, dt));
    contact_limits::add_up(gpu, pairs, bodies, law);
}

double smallest_contact_time(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies)
{
    return contact_limits::contact_time(gpu, pairs, bodies);
}

Overlap largest_overlap(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    return contact_limits::overlap(gpu, pairs, bodies, law);
}

} // namespace tread::dem
