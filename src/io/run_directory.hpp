#pragma once

#include <string>

#include "base/communicator.hpp"

namespace tread::io
{

/// What to do with a run that is already in the output directory.
enum class Existing
{
    refuse,
    overwrite
};

/// Where a run writes. Paths of its files; the directory exists.
class RunDirectory
{
public:
    /// Makes the directory (and those above it) and writes scene.toml, whose presence marks it as a run's. With
    /// Existing::overwrite an earlier run's files go first, files of others stay. Collective.
    ///
    /// InputError when it holds a run and `existing` says refuse; EnvironmentError when it cannot be made or written,
    /// and then nothing of it is left behind.
    static RunDirectory create(const Communicator& communicator, const std::string& path, Existing existing,
                               const std::string& resolved_scene);

    const std::string& path() const { return path_; }
    std::string        log() const { return path_ + "/log.txt"; }
    std::string        summary() const { return path_ + "/summary.json"; }
    std::string        time_series() const { return path_ + "/timeseries.h5"; }
    std::string        bed() const { return path_ + "/bed.h5"; }
    std::string        snapshots() const { return path_ + "/snapshots"; }

private:
    explicit RunDirectory(std::string path)
        : path_(std::move(path))
    {
    }

    std::string path_;
};

} // namespace tread::io
