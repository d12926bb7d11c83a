#include "io/summary.hpp"

#include <nlohmann/json.hpp>

#include "base/version.hpp"
#include "io/files.hpp"
#include "io/provenance.hpp"

namespace tread::io
{

namespace
{

using Json = nlohmann::ordered_json;

const char* name_of(RunStatus status)
{
    switch (status)
    {
    case RunStatus::finished:
        return "finished";
    case RunStatus::stopped:
        return "stopped";
    case RunStatus::failed:
        break;
    }
    return "failed";
}

double per_wall_second(double amount, double wall_s) { return wall_s > 0 ? amount / wall_s : 0; }

Json stages_of(const Summary& summary)
{
    Json stages = Json::array();
    for (const StageReport& stage : summary.cost.stages)
    {
        stages.push_back({{"name", stage.name},
                          {"on", stage.on},
                          {"why", stage.why},
                          {"calls", stage.calls},
                          {"seconds", stage.seconds}});
    }
    return stages;
}

Json phases_of(const Summary& summary)
{
    Json phases = Json::array();
    for (const PhaseReport& phase : summary.phases)
    {
        phases.push_back({{"name", phase.name},
                          {"start", phase.start},
                          {"time", phase.time},
                          {"end", phase.end},
                          {"settled", phase.settled ? Json(*phase.settled) : Json()},
                          {"unbalanced", phase.unbalanced},
                          {"packing_fraction", phase.packing_fraction ? Json(*phase.packing_fraction) : Json()}});
    }
    return phases;
}

Json terrain_of(const BedReport& bed)
{
    Json tables = Json::array();
    for (const TerrainReport& table : bed.terrain)
    {
        tables.push_back(
            {{"material", table.material}, {"points", table.points}, {"volume", table.volume}, {"mass", table.mass}});
    }
    return tables;
}

Json rocks_of(const BedReport& bed)
{
    Json tables = Json::array();
    for (const RocksReport& table : bed.rocks)
    {
        tables.push_back({{"shape", table.shape},
                          {"count", table.count},
                          {"volume", table.volume},
                          {"mass", table.mass},
                          {"solid_fraction", table.solid_fraction},
                          {"smallest_diameter", table.smallest_diameter},
                          {"mean_diameter", table.mean_diameter},
                          {"largest_diameter", table.largest_diameter}});
    }
    return tables;
}

Json answers_of(const PhaseAnswers& phase)
{
    Json answers = {{"phase", phase.phase}, {"from", phase.from},     {"to", phase.to},
                    {"rows", phase.rows},   {"steady", phase.steady}, {"ended", phase.ended}};
    for (const Answer& answer : phase.quantities)
    {
        answers[answer.name] = {{"mean", answer.mean},
                                {"spread", answer.spread},
                                {"standard_error", answer.standard_error},
                                {"estimated_error", answer.estimated_error ? Json(*answer.estimated_error) : Json()},
                                {"unit", answer.unit}};
    }
    return answers;
}

Json answers_of(const Summary& summary)
{
    Json bodies = Json::object();
    for (const BodyAnswers& body : summary.answers)
    {
        Json phases = Json::array();
        for (const PhaseAnswers& phase : body.phases) { phases.push_back(answers_of(phase)); }
        bodies[body.body] = phases;
    }
    return bodies;
}

Json layers_of(const BedReport& bed)
{
    Json layers = Json::array();
    for (const LayerReport& layer : bed.layers)
    {
        layers.push_back({{"rocks", layer.table}, {"sand", layer.sand}, {"rock", layer.rock}, {"void", layer.empty}});
    }
    return layers;
}

Json resolution_of(const Summary& summary)
{
    Json figures = Json::object();
    for (const Figure& figure : summary.resolution.figures)
    {
        figures[figure.name] = {{"value", figure.value},
                                {"resolved", figure.resolved},
                                {"marginal", figure.marginal},
                                {"verdict", name_of(figure.verdict())}};
    }
    return {{"verdict", name_of(verdict_of(summary))},
            {"points_across", summary.resolution.points_across},
            {"figures", figures}};
}

Json grid_error_of(const Summary& summary)
{
    if (!summary.resolution.grid_error) { return {}; }
    const GridError& error = *summary.resolution.grid_error;
    return {{"load", error.load}, {"pull", error.pull}, {"torque", error.torque}, {"sinkage", error.sinkage}};
}

} // namespace

Verdict verdict_of(const Summary& summary)
{
    return summary.outcome.status == RunStatus::failed ? Verdict::under_resolved
                                                       : verdict_of(summary.resolution.figures);
}

std::string verdict_line(const Summary& summary)
{
    if (summary.outcome.status != RunStatus::failed) { return verdict_line(summary.resolution.figures); }
    const std::string line   = std::string(name_of(verdict_of(summary))) + ": the run failed";
    const std::string coarse = coarse_figures(summary.resolution.figures);
    return coarse.empty() ? line : line + "; " + coarse;
}

std::string to_json(const Summary& summary)
{
    Json json;
    json["schema"]            = {1, 0};
    json["status"]            = name_of(summary.outcome.status);
    json["exit_code"]         = static_cast<int>(summary.outcome.exit_code);
    json["reason"]            = summary.outcome.reason;
    json["scene_hash"]        = summary.run.scene_hash;
    json["version"]           = version;
    json["commit"]            = commit();
    json["backend"]           = summary.run.backend;
    json["devices"]           = summary.run.devices;
    json["ranks"]             = summary.run.ranks;
    json["threads"]           = summary.run.threads;
    json["points"]            = summary.run.points;
    json["bodies"]            = summary.run.bodies;
    json["steps"]             = summary.cost.steps;
    json["substeps"]          = summary.cost.substeps;
    json["time"]              = summary.cost.time;
    json["wall_s"]            = summary.cost.wall_s;
    json["steps_per_s"]       = per_wall_second(static_cast<double>(summary.cost.steps), summary.cost.wall_s);
    json["sim_per_wall"]      = per_wall_second(summary.cost.time, summary.cost.wall_s);
    json["peak_device_bytes"] = summary.cost.peak_device_bytes;
    json["peak_host_bytes"]   = summary.cost.peak_host_bytes;
    json["start"]             = summary.run.start;
    json["end"]               = utc_now();
    json["restarts"]          = summary.cost.restarts;
    json["checkpoint"]   = summary.cost.checkpoints.newest.empty() ? Json() : Json(summary.cost.checkpoints.newest);
    json["checkpoints"]  = {{"written", summary.cost.checkpoints.written},
                            {"bytes", summary.cost.checkpoints.bytes},
                            {"seconds", summary.cost.checkpoints.seconds}};
    json["terrain"]      = terrain_of(summary.bed);
    json["rocks"]        = rocks_of(summary.bed);
    json["layers"]       = layers_of(summary.bed);
    json["rock_share"]   = summary.bed.rock_share;
    json["phases"]       = phases_of(summary);
    json["asleep"]       = summary.cost.asleep ? Json(*summary.cost.asleep) : Json();
    json["rocks_asleep"] = summary.cost.rocks_asleep ? Json(*summary.cost.rocks_asleep) : Json();
    json["stages"]       = stages_of(summary);
    json["errors"]       = {{"mass", summary.errors.mass},         {"momentum", summary.errors.momentum},
                            {"energy", summary.errors.energy},     {"transfer", summary.errors.transfer},
                            {"coupling", summary.errors.coupling}, {"mass_scaling", summary.errors.mass_scaling}};
    json["resolution"]   = resolution_of(summary);
    json["answers"]      = answers_of(summary);
    json["grid_error"]   = grid_error_of(summary);
    json["warnings"]     = summary.warnings;
    return json.dump(2) + "\n";
}

void write_summary(const std::string& path, const Summary& summary) { write_atomically(path, to_json(summary)); }

} // namespace tread::io
