#include "backend/launch.hpp"
#include "kernels/dem/motion/sums_impl.hpp"

namespace tread::dem
{

BodySums sum_bodies(const Cpu& cpu, Pairs<Cpu>& pairs, const BodiesView& bodies, const BodyTotals<Cpu>& totals,
                    const Vec3<double>& gravity)
{
    return sums::sum(cpu, pairs, bodies, totals, gravity);
}

} // namespace tread::dem
