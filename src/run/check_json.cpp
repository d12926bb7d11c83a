#include "run/check_json.hpp"

#include <cmath>
#include <numbers>

#include <nlohmann/json.hpp>

#include "run/plausibility.hpp"
#include "run/prediction.hpp"
#include "run/wall_time.hpp"
#include "scene/resolved.hpp"
#include "scene/spellings.hpp"
#include "world/footing.hpp"

namespace tread::run
{
namespace
{

using Json = nlohmann::ordered_json;

/// JSON has no infinity.
Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

template<class T>
Json given(const std::optional<T>& value)
{
    return value ? Json(*value) : Json(nullptr);
}

Json phases_of(const scene::Scene& scene, const std::vector<DriveWay>& ways)
{
    Json list = Json::array();
    for (std::size_t p = 0; p < scene.phases.size(); ++p)
    {
        const scene::Phase& phase = scene.phases[p];
        Json                entry{{"name", phase.name},
                   {"until", word_of(phase.until)},
                   {"at_most", scene::time_limit(phase)},
                   {"drives", nullptr},
                   {"slip", nullptr},
                   {"way", nullptr},
                   {"way_to_end", nullptr}};
        if (phase.drive)
        {
            entry["drives"] = phase.drive->body;
            entry["slip"]   = given(phase.drive->slip);
        }
        for (const DriveWay& way : ways)
        {
            if (way.phase != p) { continue; }
            entry["way"]        = way.way;
            entry["way_to_end"] = finite(way.to_end);
        }
        list.push_back(entry);
    }
    return list;
}

Json errors_of(const std::optional<io::GridError>& error)
{
    if (!error) { return nullptr; }
    return {{"pull_over_load", error->pull}, {"torque", error->torque}, {"sinkage", error->sinkage}};
}

Json patch_of(const scene::Scene& scene, const world::World& world, const solver::Plan& plan,
              const world::Footing& footing)
{
    if (!footing.patch) { return nullptr; }
    const auto       wheel = footing.driven ? driven_wheel(scene, world, plan) : std::nullopt;
    const Prediction seen  = predict(*footing.patch, world, plan, wheel);
    return {{"sinkage", footing.patch->sinkage},   {"length", footing.patch->length},
            {"width", footing.patch->width},       {"cells_across", seen.cells},
            {"points_across", seen.points},        {"grid_error", errors_of(grid_error(wheel, seen.cells))},
            {"verdict", io::name_of(seen.verdict)}};
}

Json bodies_of(const scene::Scene& scene, const world::World& world, const solver::Plan& plan)
{
    Json list = Json::array();
    for (const world::Footing& footing : world::footings(scene, world))
    {
        list.push_back({{"name", scene.bodies[footing.body].name},
                        {"weight", footing.load},
                        {"gap", given(footing.gap)},
                        {"bed_depth", footing.ground ? Json(footing.ground->depth) : Json(nullptr)},
                        {"bed_beside", footing.ground ? Json(footing.ground->beside) : Json(nullptr)},
                        {"at_rest", patch_of(scene, world, plan, footing)}});
    }
    return list;
}

Json work_of(const Workload& work)
{
    return {{"sand_steps", work.sand_steps},
            {"searches", work.searches},
            {"substeps", work.substeps},
            {"joint_substeps", work.joint_substeps},
            {"rows", work.rows},
            {"points", work.points},
            {"yielding_points", work.yielding_points},
            {"pages", work.pages},
            {"bodies", work.bodies},
            {"body_substeps", work.body_substeps},
            {"near_substeps", work.near_substeps}};
}

} // namespace

std::string check_json(const scene::Scene& scene, const world::World& world, const solver::Plan& plan,
                       const Estimate& wants, const Expected& expected, const std::vector<DriveRoom>& rooms)
{
    Json warnings = Json::array();
    for (const Warning& warning : plausibility(scene, world, wants, rooms)) { warnings.push_back(text_of(warning)); }
    const auto&  g     = scene.domain.gravity;
    const double along = std::hypot(g[0], g[1]);
    const int    cores = cores_here();
    const Json   all{
        {"title", scene.title},
        {"scene", scene::scene_hash(scene)},
        {"warnings", warnings},
        {"points", world.sand.size()},
        {"bodies", world.bodies.size()},
        {"rocks", static_cast<std::int64_t>(world.bodies.size()) - world.bodies.named},
        {"gravity", std::hypot(along, g[2])},
        {"slope_deg", std::atan2(along, -g[2]) * 180 / std::numbers::pi},
        {"phases", phases_of(scene, drive_ways(scene, world, rooms))},
        {"named_bodies", bodies_of(scene, world, plan)},
        {"dt", wants.dt},
        {"dt_limit", wants.limit},
        {"time", wants.time},
        {"steps", wants.steps},
        {"substeps", wants.substeps},
        {"cores", cores},
        {"wall_time_cores", expected.set_up + wall_time(expected.work, core_cost, cores)},
        {"wall_time_gpu", expected.set_up + wall_time(expected.work, gpu_cost, 1)},
        {"expected_time", expected.time},
        {"set_up", expected.set_up},
        {"work", work_of(expected.work)},
        {"memory", wants.memory_bytes},
        {"disk", wants.disk.all},
    };
    constexpr bool ascii = true; // no control character of a name reaches a terminal
    return all.dump(2, ' ', ascii) + "\n";
}

} // namespace tread::run
