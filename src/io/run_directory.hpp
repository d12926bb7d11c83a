#pragma once

#include <optional>
#include <string>

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

/// Where a run writes. Paths of its files; the directory exists.
class RunDirectory
{
public:
    /// Makes the directory (and those above it) and writes scene.toml, whose presence marks it as a run's. With
    /// Existing::overwrite an earlier run's files go first, files of others stay. Locks it, unless the caller has.
    /// Collective.
    ///
    /// InputError when it holds a run and `existing` says refuse; EnvironmentError when it cannot be made or written,
    /// and then nothing of it is left behind, or when another process has its lock.
    static RunDirectory create(const Communicator& communicator, const std::string& path, Existing existing,
                               const std::string& resolved_scene, std::optional<DirectoryLock> lock = {});

    /// The same without making anything: where a run would be, or is.
    static RunDirectory at(const std::string& path);

    /// Takes back what create() has made and done, as far as it can: a new directory goes, in one that was there the
    /// run's files; a run to be gone on with has its scene.toml and summary.json again. What was overwritten is gone.
    void undo() const;

    /// Of a file: as seen from the directory, if it is in it.
    std::string within(const std::string& file) const;

    bool exists() const;
    bool holds_run() const;

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
