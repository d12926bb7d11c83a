#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/communicator.hpp"
#include "base/errors.hpp"
#include "base/log.hpp"
#include "base/printable.hpp"
#include "base/process_age.hpp"
#include "base/script.hpp"
#include "base/signals.hpp"
#include "base/terminal.hpp"
#include "base/thread_wait.hpp"
#include "base/version.hpp"
#include "decomp/single_rank.hpp"
#include "io/describe.hpp"
#include "io/sdf_report.hpp"
#include "misspelt.hpp"
#include "run/agreement.hpp"
#include "run/check.hpp"
#include "run/checkpoint_clock.hpp"
#include "run/features.hpp"
#include "run/on_ranks.hpp"
#include "run/run_scene.hpp"
#include "scene/load.hpp"
#include "scene/soil_text.hpp"
#include "shape/generators/form.hpp"
#include "shape/report.hpp"
#include "shape/template.hpp"

// Command line: parses the user's arguments and calls the room that handles them.
namespace
{

using namespace tread;

struct SceneArguments
{
    std::string              path;
    std::vector<std::string> overrides;
};

struct CheckArguments
{
    SceneArguments scene;
    int            ranks = 1;
    run::CheckForm form  = run::CheckForm::page;
};

struct RunArguments
{
    SceneArguments  scene;
    run::RunOptions options;
    double          hang_timeout = 600; ///< s
    Terminal        terminal     = terminal_here();
};

enum class Report
{
    none,
    printed
};

struct SdfArguments
{
    std::string                mesh;  ///< file, built-in shape, or scene
    std::optional<std::string> shape; ///< name of a shape in the scene
    std::optional<int>         cells;
    double                     unit   = 1.0;
    bool                       repair = false;
    std::optional<std::string> stl;
    Report                     report = Report::none;
    std::string                report_file; ///< empty = none
};

ExitCode run(const RunArguments& arguments)
{
    return run::on_ranks(
        [&](const Communicator& world)
        {
            const SignalWatch  signals;
            const auto         watchdog = run::watch_ranks(world, arguments.hang_timeout);
            Log                log(world, arguments.terminal);
            const scene::Scene scene = run::load_on_every_rank(world, arguments.scene.path, arguments.scene.overrides);
            run::RunOptions    options = arguments.options;
            options.scene_file         = arguments.scene.path;
            options.wall_start         = run::wall_clock() - process_age();
            if (options.output.empty())
            {
                options.output = "runs/" + std::filesystem::path(arguments.scene.path).stem().string();
            }
            return run::run_scene(world, log, watchdog.get(), scene, options);
        });
}

ExitCode check(const CheckArguments& arguments)
{
    return run::on_ranks(
        [&](const Communicator& world)
        {
            decomp::require_single_rank(world, "tread check runs");
            const scene::Scene scene = scene::load_scene(arguments.scene.path, arguments.scene.overrides);
            std::cout << printable(run::check_scene(world, scene, arguments.ranks, arguments.form));
            return ExitCode::finished;
        });
}

struct AskedShape
{
    scene::Shape shape;
    std::string  directory; ///< base of relative file names
};

/// Finds a shape of the scene, a member of one of its rock families, or a built-in shape.
scene::Shape named_shape(const scene::Scene& scene, const std::string& name)
{
    for (const scene::Shape& family : scene.shapes)
    {
        for (const scene::Shape& rock : shape::members(family))
        {
            if (rock.name == name && rock.name != family.name) { return rock; }
        }
    }
    return shape::find_shape(scene, name);
}

/// The requested shape of a scene, or its only one.
AskedShape shape_in_scene(const SdfArguments& arguments)
{
    const scene::Scene scene = scene::load_scene(arguments.mesh, {});
    if (arguments.shape) { return {named_shape(scene, *arguments.shape), scene.directory}; }
    if (scene.shapes.size() != 1)
    {
        throw InputError(
            fmt::format("{} has {} [[shape]] tables: --shape NAME says which", arguments.mesh, scene.shapes.size()));
    }
    return {shape::find_shape(scene, scene.shapes.front().name), scene.directory};
}

AskedShape mesh_or_builtin(const SdfArguments& arguments)
{
    if (arguments.shape) { throw InputError("--shape NAME is for a SCENE.toml"); }
    // A mesh file has an extension, a built-in name has none.
    if (std::filesystem::path(arguments.mesh).extension().empty())
    {
        return {shape::find_shape({}, arguments.mesh), "."};
    }
    scene::Shape shape;
    shape.name   = arguments.mesh;
    shape.source = scene::MeshFile{arguments.mesh, arguments.unit, arguments.repair};
    return {shape, "."};
}

/// A family has several grids: lists its forms only.
ExitCode sdf_of_family(const SdfArguments& arguments, const scene::Shape& family)
{
    if (arguments.stl || arguments.report != Report::none)
    {
        throw InputError(fmt::format("'{}' is a family: --write-stl and --report are for one rock, as in --shape {}",
                                     family.name, shape::members(family).front().name));
    }
    std::cout << printable(shape::form_table(shape::family_forms(family)));
    return ExitCode::finished;
}

ExitCode sdf(const SdfArguments& arguments)
{
    const bool in_scene         = std::filesystem::path(arguments.mesh).extension() == ".toml";
    auto [requested, directory] = in_scene ? shape_in_scene(arguments) : mesh_or_builtin(arguments);
    if (arguments.cells) { requested.sdf_cells = *arguments.cells; }
    if (shape::members(requested).size() > 1) { return sdf_of_family(arguments, requested); }

    const auto  measured = shape::make_measured_template(requested, directory, [](double) { return 0.0; });
    const auto& form     = measured.form;
    std::cout << printable(shape::template_text(form));
    for (const std::string& warning : form.warnings) { std::cerr << "warning: " << printable(warning) << '\n'; }
    if (arguments.stl) { shape::write_stl(form.mesh, *arguments.stl); }
    if (arguments.report == Report::none) { return ExitCode::finished; }

    const auto qualities = shape::sdf_convergence(measured, shape::report_cells());
    std::cout << shape::convergence_text(qualities);
    if (!arguments.report_file.empty()) { io::write_sdf_report(arguments.report_file, form, qualities); }
    return ExitCode::finished;
}

ExitCode info(const std::string& path)
{
    std::cout << printable(io::describe_file(path));
    return ExitCode::finished;
}

ExitCode list_soils()
{
    std::cout << scene::soils_text();
    return ExitCode::finished;
}

/// Adds an option that accepts one of the words of `table`.
template<class T>
void add_word_option(CLI::App& command, const std::string& name, T& value, const std::map<std::string, T>& table,
                     const std::string& meaning)
{
    command
        .add_option_function<std::string>(
            name, [&value, table](const std::string& word) { value = table.at(word); }, meaning)
        ->type_name("WORD")
        ->check(CLI::IsMember(table));
}

void add_scene_options(CLI::App& command, SceneArguments& arguments)
{
    command.add_option("scene", arguments.path, "Scene file (docs/scene.md)")->type_name("SCENE.toml")->required();
    command.add_option("--set", arguments.overrides, "Replace one value of the scene, as often as needed")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
}

/// Converts an option's "HH:MM:SS" to s.
double seconds_of(const std::string& option, const std::string& text)
{
    unsigned   hours = 0, minutes = 0, seconds = 0;
    int        read       = 0;
    const bool understood = std::sscanf(text.c_str(), "%4u:%2u:%2u%n", &hours, &minutes, &seconds, &read) == 3 &&
                            static_cast<std::size_t>(read) == text.size() && minutes < 60 && seconds < 60 &&
                            hours + minutes + seconds > 0;
    if (!understood) { throw CLI::ValidationError(option, text + ": not a time over 0 as HH:MM:SS"); }
    return 3600.0 * hours + 60.0 * minutes + seconds;
}

void add_time_option(CLI::App& command, const std::string& name, double& value, const std::string& meaning)
{
    command
        .add_option_function<std::string>(
            name, [name, &value](const std::string& text) { value = seconds_of(name, text); }, meaning)
        ->type_name("HH:MM:SS");
}

run::RestartOptions restart_of(const std::string& word)
{
    if (word == "none") { return {run::RestartMode::none, ""}; }
    if (word == "auto") { return {run::RestartMode::automatic, ""}; }
    return {run::RestartMode::file, word};
}

void add_restart_options(CLI::App& command, RunArguments& arguments)
{
    command
        .add_option_function<std::string>(
            "--restart", [&](const std::string& word) { arguments.options.restart = restart_of(word); },
            "Go on from the newest usable checkpoint of the run directory (auto) or from a file; default none")
        ->type_name("auto|none|FILE");
    add_time_option(command, "--walltime-limit", arguments.options.walltime_limit,
                    "Write a checkpoint and stop (exit code 75) before so much wall time is over");
}

void add_run_options(CLI::App& command, RunArguments& arguments)
{
    add_scene_options(command, arguments.scene);
    add_word_option<run::BackendChoice>(
        command, "--backend", arguments.options.backend,
        {{"auto", run::BackendChoice::automatic}, {"cpu", run::BackendChoice::cpu}, {"cuda", run::BackendChoice::cuda}},
        "Where to compute; default auto");
    add_word_option<decomp::TransportChoice>(command, "--transport", arguments.options.decomposition.transport,
                                             {{"auto", decomp::TransportChoice::automatic},
                                              {"mpi", decomp::TransportChoice::mpi},
                                              {"nccl", decomp::TransportChoice::nccl},
                                              {"host", decomp::TransportChoice::host}},
                                             "What carries data between ranks with GPUs; default auto");
    command.add_flag_callback(
        "--share-gpus", [&] { arguments.options.gpus = run::GpuSharing::allowed; },
        "Let several ranks of a machine use one GPU");
    command.add_flag_callback(
        "--checksums", [&] { arguments.options.decomposition.checksums = decomp::Checksums::on; },
        "Compare what all ranks hold before and after points change ranks");
    command.add_option("--output", arguments.options.output, "Run directory; default runs/<name of the scene file>")
        ->type_name("DIR");
    command.add_flag_callback(
        "--overwrite", [&] { arguments.options.existing = io::Existing::overwrite; }, "Replace the run that is there");
    add_restart_options(command, arguments);
    add_time_option(
        command, "--hang-timeout", arguments.hang_timeout,
        "End a run on several ranks (exit code 4) in which one waits so long for another; default 00:10:00");
    command.add_option("--threads", arguments.options.threads, "CPU threads; default: what OpenMP finds")
        ->type_name("N")
        ->check(CLI::Range(1, 4096));
    command.add_flag_callback(
        "--quiet", [&] { arguments.terminal = Terminal::silent; }, "Nothing on the terminal but errors");
}

void add_check_options(CLI::App& command, CheckArguments& arguments)
{
    add_scene_options(command, arguments.scene);
    command.add_option("--ranks", arguments.ranks, "Show how the scene falls to N ranks; default 1")
        ->type_name("N")
        ->check(CLI::Range(1, 4096));
    CLI::Option* stages = command.add_flag_callback(
        "--stages", [&arguments] { arguments.form = run::CheckForm::page_with_stages; },
        "Also list the stages of a step, and why each is on or off");
    command
        .add_flag_callback(
            "--json", [&arguments] { arguments.form = run::CheckForm::json; },
            "Print one JSON object for programs instead")
        ->excludes(stages);
}

void add_sdf_options(CLI::App& command, SdfArguments& arguments)
{
    command.add_option("mesh", arguments.mesh, "STL or OBJ file, a built-in shape, or a scene with the shape")
        ->type_name("MESH|BUILTIN|SCENE.toml")
        ->required();
    command.add_option("--shape", arguments.shape, "Which [[shape]] of the scene; its only one needs no name")
        ->type_name("NAME");
    command.add_option("--cells", arguments.cells, "SDF cells along the longest axis; default: the shape's, or auto")
        ->type_name("N")
        ->check(CLI::Range(8, 1024));
    add_word_option<double>(command, "--unit", arguments.unit,
                            {{"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}},
                            "Length unit of the file; default m");
    command.add_flag("--repair", arguments.repair, "Mend a mesh that is not watertight");
    command
        .add_option_function<std::string>(
            "--report",
            [&](const std::string& file)
            {
                arguments.report      = Report::printed;
                arguments.report_file = file;
            },
            "Print how the field converges with its cells, and write that to the file, if given")
        ->type_name("[FILE.h5]")
        ->expected(0, 1);
    command.add_option("--write-stl", arguments.stl, "Write the surface, centred, in metres")->type_name("FILE");
}

/// Adds the commands that are scripts, with the script of each. Their options, help included, are those of the script.
std::vector<std::pair<CLI::App*, std::string>> add_script_commands(CLI::App& app)
{
    std::vector<std::pair<CLI::App*, std::string>> commands{
        {app.add_subcommand("study", "Error against run time of a scene's variants: docs/study.md"), "jobs/study.py"},
        {app.add_subcommand("validate", "Measured wheels beside tread: docs/validation.md"), "jobs/validate.py"},
        {app.add_subcommand("calibrate", "Constants of a scene from measured curves: docs/calibration.md"),
         "jobs/calibrate.py"},
        {app.add_subcommand("watch", "Follow a run or a campaign in a browser: docs/watching.md"), "jobs/watch.py"},
        {app.add_subcommand("post", "Pictures, figures and reports of runs; alone, it lists them"),
         "postprocess/post.py"}};
    for (auto& [command, script] : commands)
    {
        command->set_help_flag();
        command->prefix_command();
    }
    return commands;
}

/// Requires one subcommand; throws CLI::ParseError for --help, --version and invalid arguments.
ExitCode dispatch(CLI::App& app, int argc, char** argv)
{
    RunArguments   run_arguments;
    CheckArguments check_arguments;
    SdfArguments   sdf_arguments;
    std::string    info_path;

    CLI::App* run_command   = app.add_subcommand("run", "Run a scene");
    CLI::App* check_command = app.add_subcommand("check", "Check a scene and print the plan of its run");
    CLI::App* sdf_command   = app.add_subcommand("sdf", "Geometry and signed distance grid of a mesh");
    CLI::App* info_command  = app.add_subcommand("info", "What an HDF5 file of a run holds");
    CLI::App* soils_command = app.add_subcommand("soils", "Published soils for [[material]] soil, with sources");
    add_run_options(*run_command, run_arguments);
    add_check_options(*check_command, check_arguments);
    add_sdf_options(*sdf_command, sdf_arguments);
    info_command->add_option("file", info_path, "timeseries.h5, a snapshot ...")->type_name("FILE.h5")->required();
    const std::vector<std::pair<CLI::App*, std::string>> scripts = add_script_commands(app);
    app.require_subcommand(1);
    require_known_command(app, argc, argv);
    app.parse(argc, argv);

    if (*run_command) { return run(run_arguments); }
    if (*check_command) { return check(check_arguments); }
    if (*sdf_command) { return sdf(sdf_arguments); }
    if (*soils_command) { return list_soils(); }
    for (const auto& [command, script] : scripts)
    {
        if (*command) { become_script(script, command->remaining()); }
    }
    return info(info_path);
}

} // namespace

int main(int argc, char** argv)
{
    if (argc > 1 && std::string_view(argv[1]) == "run") { limit_spinning(argv); }
    CLI::App app("tread: rover wheels on sand and rock", "tread");
    app.set_version_flag("--version", run::features);
    app.failure_message(usage_message);
    try
    {
        return static_cast<int>(dispatch(app, argc, argv));
    }
    catch (const CLI::ParseError& error)
    {
        return app.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::bad_input);
    }
    catch (const std::exception& error)
    {
        std::cerr << "tread: error: " << text_of(error) << std::endl;
        return static_cast<int>(code_of(error));
    }
}
