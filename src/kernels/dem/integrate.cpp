#include "backend/launch.hpp"
#include "kernels/dem/integrate_impl.hpp"

namespace tread::dem
{

void clear_wrenches(const Cpu& cpu, const BodiesView& bodies)
{
    for_each(cpu, "clear wrenches", bodies.count, integration::Clear{bodies});
}

void integrate(const Cpu& cpu, const BodiesView& bodies, BodyTotal* totals, const Vec3<double>& gravity, double dt)
{
    for_each(cpu, "integrate bodies", bodies.count,
             integration::InPlace{integration::Free{bodies, totals, gravity, dt}});
}

void integrate_damped(const Cpu& cpu, const BodiesView& bodies, BodyTotal* totals, const Vec3<double>& gravity,
                      double alpha, double dt)
{
    for_each(cpu, "integrate damped bodies", bodies.count,
             integration::InPlace{integration::Damped{bodies, totals, gravity, alpha, dt}});
}

} // namespace tread::dem
