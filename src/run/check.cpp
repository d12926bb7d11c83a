#include "run/check.hpp"

#include <cmath>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

#include "base/bytes_text.hpp"
#include "run/check_json.hpp"
#include "run/check_phases.hpp"
#include "run/checkpoint_clock.hpp"
#include "run/drive_room.hpp"
#include "run/estimate.hpp"
#include "run/left_out.hpp"
#include "run/plausibility.hpp"
#include "run/prediction.hpp"
#include "run/wall_time.hpp"
#include "scene/resolved.hpp"
#include "scene/soil_text.hpp"
#include "solver/ranks/page_loads.hpp"
#include "world/bed.hpp"
#include "world/footing.hpp"
#include "world/host_points.hpp"
#include "world/layers.hpp"

namespace tread::run
{
namespace
{

std::string warning_lines(const scene::Scene& scene, const world::World& world, const Estimate& wants,
                          const std::vector<DriveRoom>& rooms)
{
    std::string text;
    for (const Warning& warning : plausibility(scene, world, wants, rooms))
    {
        text += fmt::format("warning: {}\n", text_of(warning));
    }
    return text;
}

std::string shape_lines(const world::World& world)
{
    std::string text;
    for (const auto& form : world.templates)
    {
        const auto extent = form.box.extent();
        text +=
            fmt::format("  {}: {:.4g} x {:.4g} x {:.4g} m, volume {:.6g} m3, {} triangles, {} surface nodes, SDF of "
                        "{} cells, {} ({:.2f} % of the volume)\n",
                        form.name, extent[0], extent[1], extent[2], form.unit.volume, form.mesh.triangles.size(),
                        form.nodes.positions.size(), form.sdf_cells,
                        bytes_text(static_cast<std::int64_t>(form.sdf.bytes())), 100 * form.sdf_volume_ratio);
        for (const std::string& remark : form.remarks) { text += fmt::format("    {}\n", remark); }
        for (const std::string& warning : form.warnings)
        {
            text += fmt::format("  {}: warning: {}\n", form.name, warning);
        }
    }
    return text;
}

/// Lists body heights that the scene leaves to be computed from the bed.
std::string body_lines(const scene::Scene& scene, const world::World& world)
{
    std::string text;
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    {
        if (!scene.bodies[b].on_surface) { continue; }
        text += fmt::format("'{}' stands on the surface: its centre is at z = {:.4g} m\n", scene.bodies[b].name,
                            world.bodies.position[b][2]);
    }
    return text;
}

std::string resting_text(const solver::Plan& plan, const Estimate& wants)
{
    if (!plan.rocks) { return " at that dt"; }
    return fmt::format(" of {:.4g} s and {:.3g} substeps once rocks lie on each other, by model", wants.resting_dt,
                       wants.substeps);
}

Expected expect(const scene::Scene& scene, const world::World& world, const solver::Plan& plan, const Estimate& wants,
                const std::vector<DriveRoom>& rooms, double set_up)
{
    const std::vector<PhasePace> phases = expected_phases(scene, world, plan, wants, rooms);
    const double                 time   = std::accumulate(phases.begin(), phases.end(), 0.0,
                                                          [](double sum, const PhasePace& phase) { return sum + phase.time; });
    return {set_up, time, workload(scene, world, plan, wants, phases)};
}

/// Cost of a run: points, time, memory and disk.
std::string cost_lines(const scene::Scene& scene, const world::World& world, const solver::Plan& plan,
                       const Estimate& wants, const Expected& expected)
{
    const int   cores = cores_here();
    std::string text  = fmt::format("{} points, {} bodies ({} rocks)\n", world.sand.size(), world.bodies.size(),
                                    static_cast<std::int64_t>(world.bodies.size()) - world.bodies.named);
    text += fmt::format(
        "wall time about {} on {} of this machine's cores, {} on one GPU (H200), by model for {:.3g} s simulated\n",
        duration_text(expected.set_up + wall_time(expected.work, core_cost, cores)), cores,
        duration_text(expected.set_up + wall_time(expected.work, gpu_cost, 1)), expected.time);
    text += fmt::format("dt {:.4g} s at the start (limit: {}), at most {:.4g} s simulated: {:.3g} steps{}\n", wants.dt,
                        wants.limit, wants.time, wants.steps, resting_text(plan, wants));
    text += fmt::format("memory about {} on the backend, disk at most {}\n", bytes_text(wants.memory_bytes),
                        bytes_text(wants.disk.all));
    text += fmt::format("  of it snapshots {}, time series {}, checkpoints {} ({} kept, one on its way)\n",
                        bytes_text(wants.disk.snapshots), bytes_text(wants.disk.time_series),
                        bytes_text(wants.disk.checkpoints), scene.checkpoint.keep);
    if (wants.snapshot_bytes > 0)
    {
        text += fmt::format("host memory about {} while a snapshot is written\n", bytes_text(wants.snapshot_bytes));
    }
    return text;
}

/// Memory of each of several ranks.
std::string rank_line(const world::World& world, const Estimate& wants, int ranks)
{
    const std::int64_t share = (static_cast<std::int64_t>(world.sand.size()) + ranks - 1) / ranks;
    return fmt::format(
        "each of {} ranks: memory about {} on the backend; set-up of the sand {} on the host, {} of them "
        "for its {} points and {} for the rows of all\n",
        ranks, bytes_text(memory_of_rank(wants, ranks)),
        bytes_text(share * world::bytes_of_made_point() + world::bytes_of(world.sand)),
        bytes_text(share * world::bytes_of_made_point()), share, bytes_text(world::bytes_of(world.sand)));
}

/// Gravity, and the slope that corresponds to its direction.
std::string gravity_line(const scene::Scene& scene)
{
    const auto&  g     = scene.domain.gravity;
    const double along = std::hypot(g[0], g[1]);
    std::string  text  = fmt::format("gravity {:.4g} m/s2", std::hypot(along, g[2]));
    if (along == 0) { return text + "\n"; }
    const double angle = std::atan2(along, -g[2]) * 180 / std::numbers::pi;
    return text + fmt::format(", a slope of {:.3g} degrees that rises along [{:.3g}, {:.3g}]\n", angle,
                              (0 - g[0]) / along, (0 - g[1]) / along);
}

std::string stage_lines(const scene::Scene& scene, const world::World& world, const solver::Plan& plan, int ranks)
{
    std::string text = "stages of a step:\n";
    for (const solver::Stage& stage : solver::stages(scene, plan, ranks))
    {
        text += fmt::format("  {:<4}{:<28}{}{}\n", stage.on ? "on" : "off", stage.name, stage.why,
                            stage.on ? "" : price_text(stage, scene, world));
    }
    return text;
}

} // namespace

std::string check_scene(const Communicator& communicator, const scene::Scene& scene, int ranks, CheckForm form)
{
    const double       start    = wall_clock();
    const world::World world    = world::build_world(scene);
    const double       set_up   = wall_clock() - start;
    const solver::Plan plan     = solver::make_plan(scene, world, ranks);
    const Estimate     wants    = estimate(scene, world, plan);
    const auto         rooms    = drive_rooms(scene, world);
    const Expected     expected = expect(scene, world, plan, wants, rooms, set_up);
    if (form == CheckForm::json) { return check_json(scene, world, plan, wants, expected, rooms); }
    std::string text = warning_lines(scene, world, wants, rooms);
    text += fmt::format("{}\nscene {}\n\n", scene.title, scene::scene_hash(scene));
    text += cost_lines(scene, world, plan, wants, expected) + gravity_line(scene);
    text += phase_lines(scene, drive_ways(scene, world, rooms));
    for (const std::string& line : scene::soil_lines(scene)) { text += line + "\n"; }
    for (const world::Footing& footing : world::footings(scene, world))
    {
        text += footing_lines(scene, world, plan, footing);
    }
    text += body_lines(scene, world);
    for (const std::string& note : drive_notes(scene, world, rooms)) { text += note + "\n"; }
    for (const std::string& line : world::bed_lines(world::describe_bed(scene, world))) { text += line + "\n"; }
    for (const std::string& line : world::layer_advice(scene, world)) { text += line + "\n"; }
    if (plan.sand) { text += fmt::format("sand {:.0f} bytes a point, pages included\n", wants.bytes_a_point); }
    if (plan.bodies) { text += "shapes at scale 1:\n" + shape_lines(world); }
    if (ranks > 1 && plan.sand) { text += rank_line(world, wants, ranks); }
    text += ranks == 1 ? std::string("partition: one rank\n") : solver::partition_lines(communicator, world, ranks);
    return form == CheckForm::page ? text : text + "\n" + stage_lines(scene, world, plan, ranks);
}

} // namespace tread::run
