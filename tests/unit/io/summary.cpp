#include "io/summary.hpp"

#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/errors.hpp"
#include "io/progress.hpp"
#include "temporary_directory.hpp"

namespace tread::io
{
namespace
{

std::vector<StageReport> some_stages()
{
    return {{"p2g", true, "", 100, 2.0}, {"g2p", true, "", 100, 5.0}, {"body-body", false, "no rocks", 0, 0}};
}

TEST(Summary, answers_have_units_and_nulls_for_what_is_not_known)
{
    const double none = std::numeric_limits<double>::quiet_NaN();
    Summary      summary;
    summary.answers = {
        {"wheel",
         {{"drive", 1.5, 3, 40, true, false, {{"pull", "N", 154, 9, 3, 18.0}, {"slip", "1", 0.3, 0, none, {}}}}}},
        {"rock", {}}};
    const auto answers = nlohmann::json::parse(to_json(summary))["answers"];
    EXPECT_TRUE(answers["rock"].empty());
    const auto drive = answers["wheel"][0];
    EXPECT_EQ(drive["phase"], "drive");
    EXPECT_EQ(drive["from"], 1.5);
    EXPECT_EQ(drive["to"], 3);
    EXPECT_EQ(drive["rows"], 40);
    EXPECT_EQ(drive["steady"], true);
    EXPECT_EQ(drive["ended"], false);
    const nlohmann::json pull = {
        {"mean", 154.0}, {"spread", 9.0}, {"standard_error", 3.0}, {"estimated_error", 18.0}, {"unit", "N"}};
    EXPECT_EQ(drive["pull"], pull);
    EXPECT_TRUE(drive["slip"]["standard_error"].is_null());
    EXPECT_TRUE(drive["slip"]["estimated_error"].is_null());
}

TEST(Summary, json_holds_every_field)
{
    Summary summary;
    summary.outcome.status     = RunStatus::failed;
    summary.outcome.exit_code  = ExitCode::numerical;
    summary.outcome.reason     = "point 3: velocity \"too high\"";
    summary.cost.steps         = 200;
    summary.cost.time          = 0.5;
    summary.cost.wall_s        = 4;
    summary.run.devices        = {"NVIDIA H200"};
    summary.cost.stages        = some_stages();
    summary.errors             = {1e-9, 2e-3, std::numeric_limits<double>::quiet_NaN()};
    summary.resolution.figures = {{"contact_cells", 7, 20, 6}};

    summary.phases = {{"settle", 0, 0.2, "settled", true, 1e-3, 0.6},
                      {"drive", 0.2, 0.3, "duration", std::nullopt, 0.1, std::nullopt}};

    summary.bed = {
        {{"sand", 8, 0.5, 800}}, {{"clast", 5, 0.1, 270, 0.2, 0.01, 0.02, 0.04}}, {{0, 0.75, 0.15, 0.1}}, 1.0 / 6};

    const auto json = nlohmann::json::parse(to_json(summary));
    for (const char* key : {"schema",
                            "status",
                            "exit_code",
                            "reason",
                            "scene_hash",
                            "version",
                            "commit",
                            "start",
                            "end",
                            "restarts",
                            "checkpoint",
                            "checkpoints",
                            "backend",
                            "devices",
                            "ranks",
                            "threads",
                            "points",
                            "bodies",
                            "steps",
                            "substeps",
                            "time",
                            "wall_s",
                            "steps_per_s",
                            "sim_per_wall",
                            "peak_device_bytes",
                            "peak_host_bytes",
                            "terrain",
                            "rocks",
                            "layers",
                            "rock_share",
                            "phases",
                            "asleep",
                            "stages",
                            "errors",
                            "resolution",
                            "grid_error",
                            "warnings"})
    {
        EXPECT_TRUE(json.contains(key)) << key;
    }
    EXPECT_EQ(json["layers"][0], (nlohmann::json{{"rocks", 0}, {"sand", 0.75}, {"rock", 0.15}, {"void", 0.1}}));
    EXPECT_EQ(json["status"], "failed");
    EXPECT_TRUE(json["checkpoint"].is_null());
    EXPECT_EQ(json["exit_code"], 3);
    EXPECT_EQ(json["reason"], summary.outcome.reason);
    EXPECT_EQ(json["steps_per_s"], 50.0);
    EXPECT_EQ(json["sim_per_wall"], 0.125);
    EXPECT_EQ(json["stages"][2]["on"], false);
    EXPECT_EQ(json["stages"][2]["why"], "no rocks");
    EXPECT_EQ(json["errors"]["momentum"], 2e-3);
    EXPECT_EQ(json["resolution"]["figures"]["contact_cells"]["verdict"], "marginal");
    EXPECT_EQ(json["resolution"]["figures"]["contact_cells"]["marginal"], 6);
    EXPECT_EQ(json["resolution"]["verdict"], "under-resolved") << "the run failed";
    EXPECT_EQ(json["phases"][0]["settled"], true);
    EXPECT_TRUE(json["phases"][1]["settled"].is_null());
    EXPECT_EQ(json["phases"][1]["unbalanced"], 0.1);
    EXPECT_EQ(json["phases"][0]["packing_fraction"], 0.6);
    EXPECT_TRUE(json["phases"][1]["packing_fraction"].is_null());
    EXPECT_EQ(json["terrain"][0]["volume"], 0.5);
    EXPECT_EQ(json["rocks"][0]["count"], 5);
    EXPECT_EQ(json["rocks"][0]["largest_diameter"], 0.04);
    EXPECT_TRUE(json["errors"]["energy"].is_null());
    EXPECT_TRUE(json["asleep"].is_null());
    EXPECT_TRUE(json["rocks_asleep"].is_null());
    summary.cost.asleep       = 0.75;
    summary.cost.rocks_asleep = 0.5;
    EXPECT_EQ(nlohmann::json::parse(to_json(summary))["asleep"], 0.75);
    EXPECT_EQ(nlohmann::json::parse(to_json(summary))["rocks_asleep"], 0.5);
}

TEST(Summary, log_and_file_agree_on_the_verdict_of_a_failed_run)
{
    Summary summary;
    EXPECT_EQ(verdict_line(summary), "resolved");
    summary.outcome.status = RunStatus::failed;
    EXPECT_EQ(verdict_line(summary), "under-resolved: the run failed");
    EXPECT_EQ(nlohmann::json::parse(to_json(summary))["resolution"]["verdict"], "under-resolved");
    summary.resolution.figures = {{"cells", 7, 20, 6}};
    EXPECT_EQ(verdict_line(summary), "under-resolved: the run failed; cells 7 (resolved from 20, marginal from 6)");
    summary.outcome.status = RunStatus::stopped;
    EXPECT_EQ(verdict_line(summary), "marginal: cells 7 (resolved from 20, marginal from 6)");
}

TEST(Summary, unwritable_place_is_an_environment_error)
{
    EXPECT_THROW(write_summary("/proc/nowhere/summary.json", {}), EnvironmentError);
}

TEST(Progress, line)
{
    EXPECT_EQ(progress_line({"drive", 1.2, 3.6, 24000, 800, 0.04, 5e-5, "elastic wave"}),
              "drive  t 1.2 / 3.6 s  24000 steps  800 steps/s  ETA 0:01:00  dt 5.00e-05 s (elastic wave)");
    EXPECT_NE(progress_line({"drive", 1.2, 3.6, 24000, 0, 0, 5e-5, "elastic wave"}).find("ETA ?"), std::string::npos);
    EXPECT_EQ(clock_text(3725), "1:02:05");
    EXPECT_EQ(progress_line({"drive", 1.2, 3.6, 24000, 800, 0.04, 5e-5, "elastic wave", 57.12, 0.0489}),
              "drive  t 1.2 / 3.6 s  24000 steps  800 steps/s  ETA 0:01:00  dt 5.00e-05 s (elastic wave)  "
              "pull 57.1 N  sinkage 0.0489 m");
}

TEST(Progress, status_leaves_out_what_does_not_fit)
{
    const Progress    progress{"drive", 1.2, 3.6, 24000, 800, 0.04, 5e-5, "elastic wave", 57.12, 0.0489};
    const std::string first  = "[######--------------] 33 %  drive  t 1.2 / 3.6 s  ETA 0:01:00";
    const std::string whole  = first + "  pull 57.1 N  sinkage 0.0489 m  dt 5.00e-05 s (elastic wave)  800 steps/s";
    const int         length = static_cast<int>(whole.size());
    EXPECT_EQ(status_line(progress, length + 1), whole);
    EXPECT_EQ(status_line(progress, length), whole.substr(0, whole.rfind("  ")));
    EXPECT_EQ(status_line(progress, static_cast<int>(first.size()) + 1), first);
    for (int columns = 28; columns < length; ++columns)
    {
        EXPECT_LT(status_line(progress, columns).size(), static_cast<std::size_t>(columns));
    }
}

TEST(Progress, bar_is_empty_at_the_start_and_full_at_the_end_only)
{
    const auto bar = [](double time)
    {
        const std::string line = status_line({"", time, 3.6, 0, 0, 0, 0, ""}, 80);
        return line.substr(0, line.find('%') + 1);
    };
    EXPECT_EQ(bar(0), "[--------------------] 0 %");
    EXPECT_EQ(bar(3.599), "[###################-] 99 %");
    EXPECT_EQ(bar(3.6), "[####################] 100 %");
}

TEST(Progress, table_is_sorted_and_says_what_was_left_out)
{
    EXPECT_EQ(timing_table(some_stages(), 10), "stage                             calls     seconds   share\n"
                                               "g2p                                 100       5.000   50.0%\n"
                                               "p2g                                 100       2.000   20.0%\n"
                                               "everything else                               3.000   30.0%\n"
                                               "left out: body-body - no rocks\n");
    EXPECT_NE(timing_table(some_stages(), 5).find("overlap of stages                            -2.000  -40.0%\n"),
              std::string::npos)
        << timing_table(some_stages(), 5);
}

} // namespace
} // namespace tread::io
