#include "io/run_directory.hpp"

#include <algorithm>
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

// All files that a run writes, besides scene.toml.
constexpr std::array<const char*, 6> run_files = {"log.txt",   summary_file,  "timeseries.h5",
                                                  "snapshots", "checkpoints", "bed.h5"};

// Temporary names under which it writes these.
constexpr std::array<const char*, 4> passing_files = {"scene.toml.tmp", "summary.json.tmp", "timeseries.h5.tmp",
                                                      "bed.h5.tmp"};

/// Whether the path exists; links are not followed.
bool is_there(const fs::path& path)
{
    std::error_code none;
    return fs::exists(fs::symlink_status(path, none));
}

bool holds_run(const fs::path& directory)
{
    return is_there(directory / scene_file) || is_there(directory / summary_file);
}

/// First entry that a run would replace in a directory that no run has used; empty if none.
std::string in_the_way(const fs::path& directory)
{
    if (has_lock_of_run(directory.string())) { return {}; }
    for (const char* name : run_files)
    {
        if (is_there(directory / name)) { return name; }
    }
    for (const char* name : passing_files)
    {
        if (is_there(directory / name)) { return name; }
    }
    return {};
}

/// Contents of a regular file; empty for anything else.
std::optional<std::string> text_of(const fs::path& path)
{
    return irregularity(path.string()) ? std::nullopt : std::optional<std::string>(read_file(path.string()));
}

/// Whether a path is `top` or below it, by its names.
bool is_at_or_below(const fs::path& path, const fs::path& top)
{
    return std::mismatch(top.begin(), top.end(), path.begin(), path.end()).first == top.end();
}

/// Whether a run in `directory` replaces the file, by its name or through links in the directory.
bool is_replaced(const std::string& file, const fs::path& directory)
{
    std::error_code none;
    const auto      replaces = [](const fs::path& path, const fs::path& top)
    {
        const auto is_of = [&](const char* name) { return is_at_or_below(path, top / name); };
        return is_of(scene_file) || std::any_of(run_files.begin(), run_files.end(), is_of) ||
               std::any_of(passing_files.begin(), passing_files.end(), is_of);
    };
    const fs::path real_file = fs::weakly_canonical(file, none), real_directory = fs::weakly_canonical(directory, none);
    return replaces(fs::absolute(file).lexically_normal(), fs::absolute(directory).lexically_normal()) ||
           replaces(real_file, real_directory);
}

void require_kept(const NewRun& run, const fs::path& directory)
{
    for (const NeededFile& file : run.needed)
    {
        if (!is_replaced(file.path, directory)) { continue; }
        throw InputError(fmt::format("{}: the run needs {} ({}) and would replace it; --output names another place",
                                     directory.string(), file.path, file.what));
    }
}

void require_unused(const fs::path& directory)
{
    if (holds_run(directory))
    {
        throw InputError(
            fmt::format("{}: holds a run already; --overwrite replaces it, --restart auto goes on with it, "
                        "--output names another place",
                        directory.string()));
    }
    if (const std::string name = in_the_way(directory); !name.empty())
    {
        throw InputError(fmt::format("{}: holds '{}', which a run would replace; --overwrite does, --output names "
                                     "another place",
                                     directory.string(), name));
    }
}

// First directory that create_directories would create: removed if the run cannot start after all.
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

/// The old scene.toml is removed first and the new one put in place last, so that it belongs to the files beside it
/// whenever this is killed. Nothing is removed before the new one is on the disk.
void prepare(const fs::path& directory, Existing existing, const std::string& resolved_scene)
{
    const auto remove_old = [&]
    {
        if (existing == Existing::resume) { fs::remove(directory / summary_file); }
        else
        {
            fs::remove(directory / scene_file);
            for (const char* name : run_files) { fs::remove_all(directory / name); }
        }
    };
    write_atomically((directory / scene_file).string(), resolved_scene, remove_old);
}

fs::path normal(const std::string& path)
{
    const fs::path directory = fs::path(path).lexically_normal();
    return directory.has_filename() ? directory : directory.parent_path(); // "runs/a/" becomes "runs/a"
}

} // namespace

void RunDirectory::require_free(const Communicator& communicator, const NewRun& run)
{
    const auto look = [&]
    {
        const fs::path directory = normal(run.path);
        require_kept(run, directory);
        if (run.existing == Existing::refuse) { require_unused(directory); }
    };
    on_root(communicator, look);
}

RunDirectory RunDirectory::create(const Communicator& communicator, const NewRun& run,
                                  std::optional<DirectoryLock> lock)
{
    require_free(communicator, run);
    const fs::path directory = normal(run.path);
    fs::path       missing;
    Before         before;
    const auto     make = [&]
    {
        missing           = first_missing(directory);
        before.missing    = missing.string();
        before.resumed    = run.existing == Existing::resume;
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
    on_root(communicator, [&] { usable([&] { prepare(directory, run.existing, run.resolved_scene); }); });
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

std::int64_t RunDirectory::bytes_to_remove() const
{
    std::error_code none;
    std::uintmax_t  bytes = 0;
    const auto      add   = [&](const fs::path& file)
    {
        const bool regular = fs::is_regular_file(fs::symlink_status(file, none));
        bytes += regular ? fs::file_size(file, none) : 0;
    };
    for (const char* name : run_files)
    {
        const fs::path path = fs::path(path_) / name;
        add(path);
        if (!fs::is_directory(fs::symlink_status(path, none))) { continue; }
        for (const auto& entry : fs::recursive_directory_iterator(path, none)) { add(entry.path()); }
    }
    return static_cast<std::int64_t>(bytes);
}

bool RunDirectory::holds_run() const { return tread::io::holds_run(path_); }

bool RunDirectory::is_of_run() const { return holds_run() || has_lock_of_run(path_); }

} // namespace tread::io
