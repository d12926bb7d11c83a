#include "backend/launch.cuh"
#include "kernels/dem/motion/sums_impl.hpp"

namespace tread::dem
{

BodySums sum_bodies(const Gpu& gpu, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyTotals<Gpu>& totals,
                    const Vec3<double>& gravity)
{
    return sums::sum(gpu, pairs, bodies, totals, gravity);
}

} // namespace tread::dem
