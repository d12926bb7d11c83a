#include "solver/estimate.hpp"

#include <cmath>
#include <set>

#include "kernels/mpm/grid.hpp"
#include "kernels/mpm/pages.hpp"
#include "solver/pace_limits.hpp"

namespace tread::solver
{
namespace
{

/// Bytes of a point's fields (kernels/mpm/points.hpp) and of its share of the ordering's scratch.
std::int64_t bytes_per_point(const scene::Scene& scene, const Plan& plan)
{
    const std::int64_t real  = scene.numerics.precision == scene::Precision::single_ ? 4 : 8;
    std::int64_t       bytes = 2 * 3 * 8 + (3 + 6 + 3) * real + 4 + 1;
    if (plan.affine) { bytes += 9 * real; }
    if (plan.plasticity) { bytes += 3 * real; }
    if (plan.coupling) { bytes += 9 * real; }
    constexpr std::int64_t ordering = 8 + 4 + 4 + 16;
    const std::int64_t     buffers  = 3 * 8 + 9 * real + 4 + 1;
    return bytes + ordering + buffers;
}

std::int64_t count_pages(const World& world)
{
    std::set<std::uint64_t> pages;
    for (const Vec3<double>& x : world.points.position)
    {
        pages.insert(
            mpm::page_key(mpm::page_of(mpm::cell_of(x, 1 / world.geometry.spacing, world.geometry.stencil_shift))));
    }
    return static_cast<std::int64_t>(pages.size());
}

std::int64_t bytes_per_page(const scene::Scene& scene)
{
    const std::int64_t real = scene.numerics.precision == scene::Precision::single_ ? 4 : 8;
    return (mpm::node_channels * mpm::tile_nodes + 2 * mpm::motion_channels * mpm::page_cells) * real +
           8 * (mpm::grid_sums + mpm::page_cells + 20);
}

std::int64_t template_bytes(const World& world)
{
    std::int64_t bytes = 0;
    for (const auto& form : world.templates)
    {
        bytes += static_cast<std::int64_t>(form.sdf.bytes() + 32 * form.nodes.positions.size());
    }
    return bytes;
}

double longest_time(const scene::Scene& scene)
{
    double time = 0;
    for (const scene::Phase& phase : scene.phases)
    {
        time += phase.until == scene::StopRule::duration ? phase.duration : phase.max_duration;
    }
    return time;
}

} // namespace

Estimate estimate(const scene::Scene& scene, const World& world, const Plan& plan)
{
    constexpr std::int64_t bytes_per_body = 800, snapshot_bytes_per_point = 100, snapshot_bytes_per_body = 140;
    constexpr std::int64_t bytes_per_row = 200;
    const auto             points        = static_cast<std::int64_t>(world.points.size());
    const auto             bodies        = static_cast<std::int64_t>(world.bodies.size());
    Estimate               wants{};
    wants.time         = longest_time(scene);
    wants.memory_bytes = bodies * bytes_per_body + template_bytes(world);
    if (plan.sand)
    {
        wants.memory_bytes += points * bytes_per_point(scene, plan) + count_pages(world) * bytes_per_page(scene);
    }
    const double snapshots = plan.snapshots ? 2 + wants.time / scene.output.snapshots_every : 0;
    const double rows      = 2 + wants.time / scene.output.every;
    wants.disk_bytes       = static_cast<std::int64_t>(
        snapshots * static_cast<double>(points * snapshot_bytes_per_point + bodies * snapshot_bytes_per_body) +
        rows * static_cast<double>(bytes_per_row * (2 + world.bodies.named)));
    const TimeStep step = choose_step(scene.time, pace_limits(scene, world, plan), {}, 0);
    wants.dt            = step.dt;
    wants.limit         = step.limit;
    wants.steps         = std::ceil(wants.time / step.dt);
    return wants;
}

} // namespace tread::solver
