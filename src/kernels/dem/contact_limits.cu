#include "backend/launch.cuh"
#include "kernels/dem/contact_limits_impl.hpp"

namespace tread::dem
{

void expect_contacts(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law,
                     const Vec3<double>& gravity, double dt)
{
    contact_limits::expect(gpu, pairs, bodies, law, gravity, dt);
}

double smallest_contact_time(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies)
{
    return contact_limits::contact_time(gpu, pairs, bodies);
}

double largest_overlap(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    return contact_limits::overlap(gpu, pairs, bodies, law);
}

} // namespace tread::dem
