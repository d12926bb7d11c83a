#include "run/restart.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/errors.hpp"
#include "base/regular_file.hpp"
#include "io/checkpoint_file.hpp"
#include "io/checkpoints.hpp"
#include "io/files.hpp"
#include "scene/differences.hpp"
#include "scene/resolved.hpp"

namespace tread::run
{
namespace fs = std::filesystem;

namespace
{

constexpr double most_phases = 1e6;

/// `source`: origin of the scene `stored`.
void require_same_scene(const std::string& stored, const scene::Scene& scene, std::size_t phase,
                        const std::string& source)
{
    std::vector<std::string> changed;
    for (const scene::Difference& difference : scene::differences(stored, scene::resolved_toml(scene)))
    {
        if (!scene::may_change(difference, phase)) { changed.push_back("  " + scene::describe(difference)); }
    }
    if (changed.empty()) { return; }
    throw InputError(
        fmt::format("{} is of another scene (title, [output] every and snapshots_every, [checkpoint], "
                    "[balance], [sleep] where it was given, and how long phases last that have not ended may "
                    "change):\n{}",
                    source, fmt::join(changed, "\n")));
}

void require_same_scene(const std::string& path, const scene::Scene& scene)
{
    const io::CheckpointReader reader(path);
    const double               phase = reader.read<double>("phases/now", 6, 0, 1).front();
    if (!(phase >= 0 && phase <= most_phases && phase == std::floor(phase)))
    {
        throw EnvironmentError(
            fmt::format("{}: the checkpoint cannot be used: phases/now: the phase is {}; accepted: a "
                        "whole number from 0 to {}",
                        path, phase, most_phases));
    }
    require_same_scene(reader.text("scene"), scene, static_cast<std::size_t>(phase), path);
}

bool is_finished(const io::RunDirectory& directory)
{
    if (irregularity(directory.summary())) { return false; }
    std::ifstream file(directory.summary());
    if (!file) { return false; }
    const auto summary = nlohmann::json::parse(file, nullptr, false);
    return summary.is_object() && summary.value("status", "") == "finished";
}

bool lies_in(const std::string& file, const std::string& directory)
{
    std::error_code none;
    return fs::equivalent(fs::path(file).parent_path().empty() ? "." : fs::path(file).parent_path(), directory, none);
}

/// Lists the checkpoints as seen by rank 0.
std::vector<std::string> newest_first(const Communicator& communicator, const io::RunDirectory& directory)
{
    std::string paths;
    if (communicator.rank() == 0)
    {
        for (const std::string& path : io::Checkpoints(directory.checkpoints()).newest_first())
        {
            paths += path + "\n";
        }
    }
    std::istringstream       lines(communicator.broadcast(paths));
    std::vector<std::string> found;
    for (std::string path; std::getline(lines, path);) { found.push_back(path); }
    return found;
}

bool as_rank_0_has_it(const Communicator& communicator, bool value)
{
    return communicator.maximum(communicator.rank() == 0 && value ? 1 : 0) > 0;
}

/// Reason why a checkpoint of a run's own directory cannot be used, or empty. A checkpoint renamed to another's name
/// would be ordered wrongly, and deleted when it should be kept.
std::optional<std::string> damage_of(const Communicator& communicator, const std::string& path)
{
    if (auto damage = io::damage_of(communicator, path)) { return damage; }
    std::string found;
    on_root(communicator,
            [&]
            {
                const std::int64_t step = io::CheckpointReader(path).number("step");
                if (io::Checkpoints::step_of(path) == step) { return; }
                found = fmt::format("it holds step {}, which is not what its name says", step);
            });
    found = communicator.broadcast(found);
    return found.empty() ? std::nullopt : std::optional<std::string>(found);
}

/// Puts the newest usable checkpoint into the plan.
void choose(const Communicator& communicator, const io::RunDirectory& directory, RestartPlan& plan)
{
    const std::vector<std::string> there = newest_first(communicator, directory);
    for (const std::string& path : there)
    {
        const std::optional<std::string> damage = damage_of(communicator, path);
        if (!damage)
        {
            plan.checkpoint = path;
            return;
        }
        plan.remarks.push_back(fmt::format("{}: passed over: {}", path, *damage));
    }
    if (there.empty()) { return; }
    throw EnvironmentError(fmt::format("no checkpoint of {} is usable; --overwrite starts anew:\n  {}",
                                       directory.path(), fmt::join(plan.remarks, "\n  ")));
}

RestartPlan plan_from_directory(const Communicator& communicator, const scene::Scene& scene,
                                const io::RunDirectory& directory, RestartPlan plan)
{
    if (!as_rank_0_has_it(communicator, directory.holds_run())) { return plan; }
    on_root(communicator,
            [&]
            {
                plan.finished = is_finished(directory);
                if (!plan.finished) { return; }
                require_same_scene(io::read_file(directory.scene()), scene, scene::no_phase_to_come, directory.path());
            });
    plan.finished = as_rank_0_has_it(communicator, plan.finished);
    if (plan.finished) { return plan; }
    choose(communicator, directory, plan);
    plan.existing = plan.checkpoint.empty() ? io::Existing::overwrite : io::Existing::resume;
    if (!plan.checkpoint.empty())
    {
        on_root(communicator, [&] { require_same_scene(plan.checkpoint, scene); });
        return plan;
    }
    on_root(communicator, [&] { require_same_scene(io::read_file(directory.scene()), scene, 0, directory.path()); });
    plan.remarks.push_back(fmt::format("{} has no checkpoint yet: the run begins again", directory.path()));
    return plan;
}

RestartPlan plan_from_file(const Communicator& communicator, const scene::Scene& scene, const std::string& file,
                           const io::RunDirectory& directory, RestartPlan plan)
{
    const bool own = as_rank_0_has_it(communicator, lies_in(file, directory.checkpoints()));
    if (const auto damage = own ? damage_of(communicator, file) : io::damage_of(communicator, file))
    {
        throw EnvironmentError(fmt::format("{}: cannot be used: {}", file, *damage));
    }
    on_root(communicator, [&] { require_same_scene(file, scene); });
    plan.checkpoint = file;
    if (own) { plan.existing = io::Existing::resume; }
    return plan;
}

} // namespace

RestartPlan plan_restart(const Communicator& communicator, const scene::Scene& scene, const RestartOptions& options,
                         const std::string& output, io::Existing existing)
{
    RestartPlan plan;
    plan.existing = existing;
    if (options.mode == RestartMode::none) { return plan; }
    const io::RunDirectory directory = io::RunDirectory::at(output);
    if (options.mode == RestartMode::automatic && existing == io::Existing::overwrite)
    {
        throw InputError("--restart auto goes on with the run that is there, and --overwrite replaces it: one of them");
    }
    if (as_rank_0_has_it(communicator, directory.is_of_run())) { plan.lock.emplace(communicator, directory.path()); }
    return options.mode == RestartMode::automatic
               ? plan_from_directory(communicator, scene, directory, std::move(plan))
               : plan_from_file(communicator, scene, options.file, directory, std::move(plan));
}

} // namespace tread::run
