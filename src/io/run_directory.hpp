#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "io/directory_lock.hpp"

namespace tread::io
{

/// What to do with a run that is already in the output directory.
enum class Existing
{
    refuse,
    overwrite,
    resume ///< keep its files, but for summary.json, and go on with them
};

/// A file that a run reads and that must outlast it.
struct NeededFile
{
    std::string path;
    std::string what; ///< it is: "[[rocks]] 0 from"
};

/// What a run asks of its directory.
struct NewRun
{
    std::string             path;
    Existing                existing = Existing::refuse;
    std::string             resolved_scene;
    std::vector<NeededFile> needed;
};

/// Where a run writes. Paths of its files; the directory exists.
class RunDirectory
{
public:
    /// InputError when a run may not begin in its directory: it holds a run and `existing` says refuse, it holds
    /// somebody's files by names that a run takes, or what the run needs is among those that it would replace. Looks
    /// only. Collective.
    static void require_free(const Communicator& communicator, const NewRun& run);

    /// Makes the directory (and those above it) and writes scene.toml, whose presence marks it as a run's. With
    /// Existing::overwrite an earlier run's files go first, files of others stay. Locks it, unless the caller has.
    /// Collective.
    ///
    /// InputError as of require_free; EnvironmentError when it cannot be made or written, and then nothing of it is
    /// left behind, or when another process has its lock.
    static RunDirectory create(const Communicator& communicator, const NewRun& run,
                               std::optional<DirectoryLock> lock = {});

    /// The same without making anything: where a run would be, or is.
    static RunDirectory at(const std::string& path);

    /// Takes back what create() has made and done, as far as it can: a new directory goes, in one that was there the
    /// run's files; a run to be gone on with has its scene.toml and summary.json again. What was overwritten is gone.
    void undo() const;

    /// Of a file: as seen from the directory, if it is in it.
    std::string within(const std::string& file) const;

    /// Bytes of the files that a run which begins anew here would remove. On any one rank.
    std::int64_t bytes_to_remove() const;

    bool holds_run() const;

    /// Whether a run has been at work in it, be it that it was stopped before its files were there.
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

    /// What was there before create().
    struct Before
    {
        std::string                missing; ///< the first directory that was not; empty = all were
        bool                       resumed    = false;
        bool                       had_a_lock = false;
        std::optional<std::string> scene, summary; ///< of a run that is gone on with
    };

    std::string                  path_;
    std::optional<DirectoryLock> lock_;
    Before                       before_;
};

} // namespace tread::io
