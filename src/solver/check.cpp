#include <fmt/format.h>

#include "base/bytes_text.hpp"
#include "scene/resolved.hpp"
#include "solver/bed.hpp"
#include "solver/estimate.hpp"
#include "solver/layers.hpp"
#include "solver/left_out.hpp"
#include "solver/page_loads.hpp"
#include "solver/run.hpp"

namespace tread::solver
{
namespace
{

std::string shape_lines(const World& world)
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

std::string resting_text(const Plan& plan, const Estimate& wants)
{
    if (!plan.rocks) { return " at that dt"; }
    return fmt::format(" of {:.4g} s and {:.3g} substeps once rocks lie on each other, by model", wants.resting_dt,
                       wants.substeps);
}

} // namespace

std::string check(const Communicator& communicator, const scene::Scene& scene, int ranks)
{
    const World    world = build_world(scene);
    const Plan     plan  = make_plan(scene, world);
    const Estimate wants = estimate(scene, world, plan);
    std::string    text  = fmt::format("{}\nscene {}\n\nstages of a step:\n", scene.title, scene::scene_hash(scene));
    for (const Stage& stage : stages(scene, plan, ranks))
    {
        text += fmt::format("  {:<4}{:<28}{}{}\n", stage.on ? "on" : "off", stage.name, stage.why,
                            stage.on ? "" : price_text(stage, scene, world));
    }
    text += fmt::format("\n{} points, {} bodies ({} rocks)\n", world.points.size(), world.bodies.size(),
                        static_cast<std::int64_t>(world.bodies.size()) - world.bodies.named);
    for (const std::string& line : bed_lines(describe_bed(scene, world))) { text += "  " + line + "\n"; }
    for (const std::string& line : layer_advice(scene, world)) { text += "  " + line + "\n"; }
    if (plan.bodies) { text += "shapes at scale 1:\n" + shape_lines(world); }
    text += fmt::format("memory about {} on the backend, disk at most {}\n", bytes_text(wants.memory_bytes),
                        bytes_text(wants.disk.all()));
    text += fmt::format("  of it snapshots {}, time series {}, checkpoints {} ({} kept, one on its way)\n",
                        bytes_text(wants.disk.snapshots), bytes_text(wants.disk.time_series),
                        bytes_text(wants.disk.checkpoints), scene.checkpoint.keep);
    if (wants.snapshot_bytes > 0)
    {
        text += fmt::format("host memory about {} while a snapshot is written\n", bytes_text(wants.snapshot_bytes));
    }
    text += fmt::format("dt {:.4g} s at the start (limit: {}), at most {:.4g} s simulated: {:.3g} steps{}\n", wants.dt,
                        wants.limit, wants.time, wants.steps, resting_text(plan, wants));
    if (plan.sand) { text += fmt::format("sand {:.0f} bytes a point, pages included\n", wants.bytes_a_point); }
    return text + (ranks == 1 ? std::string("partition: one rank\n") : partition_lines(communicator, world, ranks));
}

} // namespace tread::solver
