#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

// The directory with a run's checkpoints. Calls of one process.
namespace tread::io
{

class Checkpoints
{
public:
    explicit Checkpoints(std::string directory)
        : directory_(std::move(directory))
    {
    }

    /// Of the state after so many steps.
    std::string path(std::int64_t step) const;

    /// That of a path as above; empty if its name is another.
    static std::optional<std::int64_t> step_of(const std::string& path);

    /// Paths of those there are, newest first: by their steps, whatever the clock said when they were written.
    std::vector<std::string> newest_first() const;

    /// Makes the directory if need be, and removes what a run that was killed has left half written.
    void prepare() const;

    /// After one more is there: `latest` names it, and only the newest `keep` stay.
    void settle(const std::string& newest, int keep) const;

    /// Those newer than so many steps: they are of a future that will not come about.
    void remove_after(std::int64_t step) const;

private:
    std::string directory_;
};

} // namespace tread::io
