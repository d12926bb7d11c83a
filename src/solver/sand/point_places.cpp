#include "solver/sand/point_places.hpp"

#include <algorithm>
#include <type_traits>

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
    constexpr double       loosest = 1.5;   // of the initial volume: looser sand floats, and counts as no larger
    constexpr std::int64_t block   = 65536; // points on the host at a time: all of them would be 32 bytes each
    const Exec             exec    = points.position.exec();
    const auto             part    = [&exec](const auto* values, std::int64_t count)
    {
        std::vector<std::decay_t<decltype(*values)>> copy(static_cast<std::size_t>(count));
        copy_to_host(exec, copy.data(), values, copy.size() * sizeof(*values));
        return copy;
    };
    for (std::int64_t first = 0; first < points.count; first += block)
    {
        const std::int64_t count = std::min(block, points.count - first);
        const auto         x     = part(points.position.data() + first, count),
                   y             = part(points.position.data() + points.stride + first, count),
                   z             = part(points.position.data() + 2 * points.stride + first, count);
        const auto volume        = part(points.volume.data() + first, count),
                   ratio         = part(points.volume_ratio.data() + first, count);
        for (std::size_t i = 0; i < x.size(); ++i)
        {
            bins.add_cube({x[i], y[i], z[i]},
                          static_cast<double>(volume[i]) * std::min(static_cast<double>(ratio[i]), loosest));
        }
    }
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void append_positions(const mpm::Points<Exec, Real>&, std::vector<Vec3<double>>&);                        \
    template void add_cubes(const mpm::Points<Exec, Real>&, world::TerrainBins&)
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
