#include "io/run_directory.hpp"

#include <array>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "io/files.hpp"

namespace tread::io
{

namespace
{

namespace fs = std::filesystem;

constexpr const char* scene_file = "scene.toml";

// Everything that a run writes, besides scene.toml.
constexpr std::array<const char*, 6> run_files = {"log.txt",   "summary.json", "timeseries.h5",
                                                  "snapshots", "checkpoints",  "bed.h5"};

bool holds_run(const fs::path& directory)
{
    std::error_code none;
    return fs::exists(directory / scene_file, none) || fs::exists(directory / "summary.json", none);
}

// The first directory that create_directories would make: what to remove if the run cannot start after all.
fs::path first_missing(fs::path directory)
{
    std::error_code none;
    fs::path        missing;
    while (!directory.empty() && !fs::exists(directory, none))
    {
        missing   = directory;
        directory = directory.parent_path();
    }
    return missing;
}

void prepare(const fs::path& directory, Existing existing, const std::string& resolved_scene)
{
    if (existing == Existing::refuse && holds_run(directory))
    {
        throw InputError(fmt::format("{}: holds a run already; --overwrite replaces it, --output names another place",
                                     directory.string()));
    }
    const fs::path missing = first_missing(directory);
    try
    {
        fs::create_directories(directory);
        write_atomically((directory / scene_file).string(), resolved_scene);
        for (const char* name : run_files) { fs::remove_all(directory / name); }
    }
    catch (const std::exception& error)
    {
        std::error_code none;
        if (!missing.empty()) { fs::remove_all(missing, none); }
        throw EnvironmentError(fmt::format("the output directory cannot be used: {}", error.what()));
    }
}

} // namespace

RunDirectory RunDirectory::create(const Communicator& communicator, const std::string& path, Existing existing,
                                  const std::string& resolved_scene)
{
    fs::path directory = fs::path(path).lexically_normal();
    if (!directory.has_filename()) { directory = directory.parent_path(); } // "runs/a/" is "runs/a"
    on_root(communicator, [&] { prepare(directory, existing, resolved_scene); });
    return RunDirectory(directory.string());
}

} // namespace tread::io
