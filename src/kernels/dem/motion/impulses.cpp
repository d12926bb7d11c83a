#include "backend/launch.hpp"
#include "kernels/dem/motion/impulses_impl.hpp"

namespace tread::dem
{

void measure_activity(const Cpu& exec, const BodiesView& bodies, const double* bounding_radii,
                      const Vec3<double>& gravity, BodyActivity* activity)
{
    for_each(exec, "measure activity", bodies.count, impulse_steps::Measure{bodies, bounding_radii, gravity, activity});
}

} // namespace tread::dem
