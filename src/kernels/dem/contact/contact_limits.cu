#include "backend/instantiate.hpp"
#include "backend/launch.cuh"
#include "kernels/dem/contact/contact_limits_impl.hpp"
#include "kernels/dem/contact/lane_parts.cuh"

namespace tread::dem
{

template<class Exec>
void expect_contacts(const Exec& gpu, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law,
                     const Vec3<double>& gravity, double dt, const SharedView& shared)
{
    constexpr int threads = 128;
    const auto    run     = [&](const char* name, const auto& part)
    { for_each_block<threads>(gpu, name, part.blocks, part.f); };
    contact_limits::expect(
        gpu, pairs, bodies, law, gravity, dt, shared,
        [&](const char* name, const auto& item) { run(name, pair_part<threads, 1>(pairs.view(), item)); },
        [&](const char* name, const auto& item) { run(name, body_part<threads, 1>(bodies.count, pairs, item)); });
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template void expect_contacts(const Exec&, Pairs<Exec>&, const BodiesView&, const BodyLaw&, const Vec3<double>&,   \
                                  double, const SharedView&)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::dem
