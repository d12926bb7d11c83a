#include <algorithm>

#include "backend/instantiate.hpp"
#include "solver/mpm_solver.hpp"

// Positions of the sand on the host.
namespace tread::solver
{

template<class Exec, class Real>
std::vector<const mpm::Points<Exec, Real>*> MpmSolver<Exec, Real>::all_points() const
{
    if (!sleep_) { return {&points_}; }
    return {&points_, &sleep_->points()};
}

template<class Exec, class Real>
std::vector<Vec3<double>> MpmSolver<Exec, Real>::positions() const
{
    std::vector<Vec3<double>> out;
    for (const mpm::Points<Exec, Real>* points : all_points())
    {
        const std::vector<double> planes = points->position.to_host();
        const auto                stride = static_cast<std::size_t>(points->stride);
        for (std::size_t i = 0; i < static_cast<std::size_t>(points->count); ++i)
        {
            out.emplace_back(planes[i], planes[stride + i], planes[2 * stride + i]);
        }
    }
    return out;
}

template<class Exec, class Real>
void MpmSolver<Exec, Real>::add_to(world::TerrainBins& bins) const
{
    constexpr double loosest = 1.5; // of the initial volume: looser sand floats, and counts as no larger
    for (const mpm::Points<Exec, Real>* points : all_points())
    {
        const std::vector<double> planes = points->position.to_host();
        const std::vector<Real>   volume = points->volume.to_host(), ratio = points->volume_ratio.to_host();
        const auto                stride = static_cast<std::size_t>(points->stride);
        for (std::size_t i = 0; i < static_cast<std::size_t>(points->count); ++i)
        {
            bins.add_cube({planes[i], planes[stride + i], planes[2 * stride + i]},
                          static_cast<double>(volume[i]) * std::min(static_cast<double>(ratio[i]), loosest));
        }
    }
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template std::vector<const mpm::Points<Exec, Real>*> MpmSolver<Exec, Real>::all_points() const;                    \
    template std::vector<Vec3<double>>                   MpmSolver<Exec, Real>::positions() const;                     \
    template void                                        MpmSolver<Exec, Real>::add_to(world::TerrainBins&) const
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
