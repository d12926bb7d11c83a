#include "backend/launch.cuh"
#include "kernels/dem/integrate_impl.hpp"

namespace tread::dem
{

void clear_wrenches(const Gpu& gpu, const BodiesView& bodies)
{
    for_each(gpu, "clear wrenches", bodies.count, integration::Clear{bodies});
}

void integrate(const Gpu& gpu, const BodiesView& bodies, BodyTotal* totals, const Vec3<double>& gravity, double dt)
{
    for_each(gpu, "integrate bodies", bodies.count,
             integration::InPlace{integration::Free{bodies, totals, gravity, dt}});
}

void integrate_damped(const Gpu& gpu, const BodiesView& bodies, BodyTotal* totals, const Vec3<double>& gravity,
                      double alpha, double dt)
{
    for_each(gpu, "integrate damped bodies", bodies.count,
             integration::InPlace{integration::Damped{bodies, totals, gravity, alpha, dt}});
}

} // namespace tread::dem
