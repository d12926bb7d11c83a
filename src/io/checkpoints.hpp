#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

// Directory of a run's checkpoints. Called by one process.
namespace tread::io
{

class Checkpoints
{
public:
    explicit Checkpoints(std::string directory)
        : directory_(std::move(directory))
    {
    }

    /// Path of the checkpoint after `step` steps.
    std::string path(std::int64_t step) const;

    /// Step number encoded in a path as above; empty for any other name.
    static std::optional<std::int64_t> step_of(const std::string& path);

    /// Paths of all checkpoints, newest first by step number, whatever their time stamps.
    std::vector<std::string> newest_first() const;

    /// Creates the directory if needed, and removes partial files of a killed run.
    void prepare() const;

    /// Points `latest` to the new checkpoint and deletes all but the newest `keep`.
    void settle(const std::string& newest, int keep) const;

    /// Deletes checkpoints later than the step restarted from.
    void remove_after(std::int64_t step) const;

private:
    std::string directory_;
};

} // namespace tread::io
