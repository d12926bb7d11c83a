#include "solver/sand/point_upload.hpp"

#include "backend/instantiate.hpp"
#include "solver/ranks/page_runs.hpp"

namespace tread::solver
{
namespace
{

template<class Real>
std::vector<Real> cast(const std::vector<double>& values)
{
    return {values.begin(), values.end()};
}

/// Converts a vector per point to planes, one component after the other.
template<class Real, int components>
std::vector<Real> planes(const std::vector<Eigen::Matrix<double, components, 1>>& values)
{
    const std::size_t n = values.size();
    std::vector<Real> out(components * n);
    for (std::size_t i = 0; i < n; ++i)
    {
        for (std::size_t c = 0; c < components; ++c)
        {
            out[c * n + i] = static_cast<Real>(values[i][static_cast<Eigen::Index>(c)]);
        }
    }
    return out;
}

} // namespace

template<class Exec, class Real>
void upload_points(mpm::Points<Exec, Real>& points, const world::HostPoints& host, mpm::PointFields fields)
{
    const auto n = host.size();
    points.allocate(static_cast<std::int64_t>(n), fields);
    if (n == 0) { return; }
    points.position.assign(planes<double, 3>(host.position));
    points.start.assign(planes<double, 3>(host.position));
    points.stress.assign(planes<Real, 6>(host.stress));
    points.mass.assign(cast<Real>(host.mass));
    points.volume.assign(cast<Real>(host.volume));
    points.volume_ratio.assign(std::vector<Real>(n, Real(1)));
    points.material.assign(host.material);
    if (!host.velocity.empty()) { points.velocity.assign(planes<Real, 3>(host.velocity)); }
    if (!host.velocity.empty() && fields.coupled) { points.grid_velocity.assign(planes<Real, 3>(host.velocity)); }
    if (!host.plastic_shear.empty() && fields.plastic) { points.plastic_shear.assign(cast<Real>(host.plastic_shear)); }
    points.id.assign(host.id);
}

template<class Exec>
world::HostPoints own_points(const scene::Scene& scene, const world::World& world,
                             const decomp::Decomposition<Exec>& decomposition)
{
    const mpm::Lattice           lattice = world.geometry.lattice();
    std::vector<world::PointRow> own;
    const auto                   add = [&](const world::PointRow& row, std::uint32_t from, std::uint32_t to)
    {
        // Runs in neighbouring pages become one row.
        const bool goes_on = from > 0 && !own.empty() && own.back().first + own.back().count == row.first + from;
        if (goes_on) { own.back().count += to - from; }
        else { own.push_back(part_of(row, from, to)); }
    };
    for (const world::PointRow& row : world.sand.rows)
    {
        for_each_page_run(lattice, row,
                          [&](std::uint64_t page, std::uint32_t from, std::uint32_t to)
                          {
                              if (decomposition.owners.owner(page) == decomposition.rank()) { add(row, from, to); }
                          });
    }
    return world::make_points(scene, world, own);
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template world::HostPoints own_points(const scene::Scene&, const world::World&, const decomp::Decomposition<Exec>&)
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void upload_points(mpm::Points<Exec, Real>&, const world::HostPoints&, mpm::PointFields)
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
