#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "io/directory_lock.hpp"

namespace tread::io
{

/// Treatment of a run that already is in the output directory.
enum class Existing
{
    refuse,
    overwrite,
    resume ///< keep its files, except summary.json, and continue them
};

/// An input file of a run, which must not be replaced by its output.
struct NeededFile
{
    std::string path;
    std::string what; ///< its use: "[[rocks]] 0 from"
};

/// Requirements of a new run on its directory.
struct NewRun
{
    std::string             path;
    Existing                existing = Existing::refuse;
    std::string             resolved_scene;
    std::vector<NeededFile> needed;
};

/// Output directory of a run, with the paths of its files; the directory exists.
class RunDirectory
{
public:
    /// Checks, without changes, that a run may start in its directory. InputError if it holds a run and `existing` says
    /// refuse, if it holds unrelated files under names that a run uses, or if an input of the run would be replaced.
    /// Collective.
    static void require_free(const Communicator& communicator, const NewRun& run);

    /// Creates the directory (and its parents) and writes scene.toml, which marks it as a run's. With
    /// Existing::overwrite an earlier run's files are removed first, other files stay. Takes the lock, unless the
    /// caller holds it. Collective.
    ///
    /// InputError as in require_free. EnvironmentError if it cannot be created or written, and then nothing is left
    /// behind, or if another process holds its lock.
    static RunDirectory create(const Communicator& communicator, const NewRun& run,
                               std::optional<DirectoryLock> lock = {});

    /// Paths of a present or future run; creates nothing.
    static RunDirectory at(const std::string& path);

    /// Undoes create() as far as possible: removes a new directory, or the run's files from an existing one, and
    /// restores scene.toml and summary.json of a run to be resumed. Overwritten files are lost.
    void undo() const;

    /// Path of a file relative to the directory, if it is inside.
    std::string within(const std::string& file) const;

    /// Bytes of the files that a new run here would remove. Called on any one rank.
    std::int64_t bytes_to_remove() const;

    bool holds_run() const;

    /// Whether a run has used the directory, even if it stopped before it wrote its files.
    bool is_of_run() const;

    const std::string& path() const { return path_; }
    std::string        log() const { return path_ + "/log.txt"; }
    std::string        summary() const { return path_ + "/summary.json"; }
    std::string        time_series() const { return path_ + "/timeseries.h5"; }
    std::string        bed() const { return path_ + "/bed.h5"; }
    std::string        snapshots() const { return path_ + "/snapshots"; }
    std::string        checkpoints() const { return path_ + "/checkpoints"; }
    std::string        scene() const { return path_ + "/scene.toml"; }

private:
    explicit RunDirectory(std::string path)
        : path_(std::move(path))
    {
    }

    /// State of the directory before create().
    struct Before
    {
        std::string                missing; ///< the outermost directory that did not exist; empty = all did
        bool                       resumed    = false;
        bool                       had_a_lock = false;
        std::optional<std::string> scene, summary; ///< of a run that is resumed
    };

    std::string                  path_;
    std::optional<DirectoryLock> lock_;
    Before                       before_;
};

} // namespace tread::io
