#include "solver/sand/point_places.hpp"

#include <algorithm>

#include "backend/instantiate.hpp"

namespace tread::solver
{

template<class Exec, class Real>
void append_positions(const mpm::Points<Exec, Real>& points, std::vector<Vec3<double>>& positions)
{
    const std::vector<double> planes = points.position.to_host();
    const auto                stride = static_cast<std::size_t>(points.stride);
    for (std::size_t i = 0; i < static_cast<std::size_t>(points.count); ++i)
    {
        positions.emplace_back(planes[i], planes[stride + i], planes[2 * stride + i]);
    }
}

template<class Exec, class Real>
void add_cubes(const mpm::Points<Exec, Real>& points, world::TerrainBins& bins)
{
    constexpr double          loosest = 1.5; // of the initial volume: looser sand floats, and counts as no larger
    const std::vector<double> planes  = points.position.to_host();
    const std::vector<Real>   volume = points.volume.to_host(), ratio = points.volume_ratio.to_host();
    const auto                stride = static_cast<std::size_t>(points.stride);
    for (std::size_t i = 0; i < static_cast<std::size_t>(points.count); ++i)
    {
        bins.add_cube({planes[i], planes[stride + i], planes[2 * stride + i]},
                      static_cast<double>(volume[i]) * std::min(static_cast<double>(ratio[i]), loosest));
    }
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void append_positions(const mpm::Points<Exec, Real>&, std::vector<Vec3<double>>&);                        \
    template void add_cubes(const mpm::Points<Exec, Real>&, world::TerrainBins&)
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
