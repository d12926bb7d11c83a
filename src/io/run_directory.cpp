#include "io/run_directory.hpp"

#include <array>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/regular_file.hpp"
#include "io/files.hpp"

namespace tread::io
{

namespace
{

namespace fs = std::filesystem;

constexpr const char* scene_file   = "scene.toml";
constexpr const char* summary_file = "summary.json";

// Everything that a run writes, besides scene.toml.
constexpr std::array<const char*, 6> run_files = {"log.txt",   summary_file,  "timeseries.h5",
                                                  "snapshots", "checkpoints", "bed.h5"};

bool holds_run(const fs::path& directory)
{
    std::error_code none;
    return fs::exists(directory / scene_file, none) || fs::exists(directory / summary_file, none);
}

/// Of a directory that no run has used: what one would replace; empty if there is nothing.
std::string in_the_way(const fs::path& directory)
{
    std::error_code none;
    if (fs::exists(directory / lock_file, none)) { return {}; }
    for (const char* name : run_files)
    {
        if (fs::exists(directory / name, none)) { return name; }
    }
    return {};
}

/// Of a file, if it is one.
std::optional<std::string> text_of(const fs::path& path)
{
    return irregularity(path.string()) ? std::nullopt : std::optional<std::string>(read_file(path.string()));
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

/// scene.toml goes first and comes last: whenever this is killed, what it says is of the files beside it.
void prepare(const fs::path& directory, Existing existing, const std::string& resolved_scene)
{
    if (existing == Existing::resume) { fs::remove(directory / summary_file); }
    else
    {
        fs::remove(directory / scene_file);
        for (const char* name : run_files) { fs::remove_all(directory / name); }
    }
    write_atomically((directory / scene_file).string(), resolved_scene);
}

fs::path normal(const std::string& path)
{
    const fs::path directory = fs::path(path).lexically_normal();
    return directory.has_filename() ? directory : directory.parent_path(); // "runs/a/" is "runs/a"
}

} // namespace

RunDirectory RunDirectory::create(const Communicator& communicator, const std::string& path, Existing existing,
                                  const std::string& resolved_scene, std::optional<DirectoryLock> lock)
{
    const fs::path directory = normal(path);
    fs::path       missing;
    Before         before;
    const auto     make = [&]
    {
        if (existing == Existing::refuse && tread::io::holds_run(directory))
        {
            throw InputError(fmt::format(
                "{}: holds a run already; --overwrite replaces it, --restart auto goes on with it, --output "
                "names another place",
                directory.string()));
        }
        if (const std::string name = in_the_way(directory); existing == Existing::refuse && !name.empty())
        {
            throw InputError(fmt::format("{}: holds '{}', which a run would replace; --overwrite does, --output names "
                                         "another place",
                                         directory.string(), name));
        }
        missing           = first_missing(directory);
        before.missing    = missing.string();
        before.resumed    = existing == Existing::resume;
        before.had_a_lock = fs::exists(directory / lock_file);
        if (before.resumed)
        {
            before.scene   = text_of(directory / scene_file);
            before.summary = text_of(directory / summary_file);
        }
        fs::create_directories(directory);
    };
    const auto usable = [&](const auto& work)
    {
        try
        {
            work();
        }
        catch (const InputError&)
        {
            throw;
        }
        catch (const std::exception& error)
        {
            std::error_code none;
            if (!missing.empty()) { fs::remove_all(missing, none); }
            throw EnvironmentError(fmt::format("the output directory cannot be used: {}", error.what()));
        }
    };
    on_root(communicator, [&] { usable(make); });
    if (!lock)
    {
        usable([&] { lock.emplace(communicator, directory.string()); });
    }
    on_root(communicator, [&] { usable([&] { prepare(directory, existing, resolved_scene); }); });
    RunDirectory made(directory.string());
    made.lock_   = std::move(lock);
    made.before_ = std::move(before);
    return made;
}

void RunDirectory::undo() const
{
    std::error_code none;
    const fs::path  directory = path_;
    if (!before_.missing.empty())
    {
        fs::remove_all(before_.missing, none);
        return;
    }
    if (before_.resumed)
    {
        if (before_.scene) { write_atomically(scene(), *before_.scene); }
        if (before_.summary) { write_atomically(summary(), *before_.summary); }
        return;
    }
    fs::remove(directory / scene_file, none);
    for (const char* name : run_files) { fs::remove_all(directory / name, none); }
    if (!before_.had_a_lock) { fs::remove(directory / lock_file, none); }
}

RunDirectory RunDirectory::at(const std::string& path) { return RunDirectory(normal(path).string()); }

std::string RunDirectory::within(const std::string& file) const
{
    const fs::path relative = fs::path(file).lexically_relative(path_);
    return relative.empty() || *relative.begin() == ".." ? file : relative.string();
}

bool RunDirectory::exists() const { return fs::is_directory(path_); }

bool RunDirectory::holds_run() const { return tread::io::holds_run(path_); }

} // namespace tread::io
