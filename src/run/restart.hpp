#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "io/run_directory.hpp"
#include "scene/scene.hpp"

namespace tread::run
{

/// Whether a run goes on with what an earlier one has left.
enum class RestartMode
{
    none,
    automatic, ///< from the newest usable checkpoint of the run's directory; from the start if there is none
    file
};

struct RestartOptions
{
    RestartMode mode = RestartMode::none;
    std::string file;
};

/// What comes of it.
struct RestartPlan
{
    bool                     finished = false; ///< nothing is left to do
    std::string              checkpoint;       ///< to go on from; empty = from the start
    io::Existing             existing = io::Existing::refuse;
    std::vector<std::string> remarks; ///< for the log: what was passed over, and why

    std::optional<io::DirectoryLock> lock; ///< of the directory, if it was a run's
};

/// Collective. InputError when the scene is another than the one to go on with (every difference is named), when
/// --overwrite contradicts; EnvironmentError when checkpoints are there and none is usable, or another process is at
/// work in the directory.
RestartPlan plan_restart(const Communicator& communicator, const scene::Scene& scene, const RestartOptions& options,
                         const std::string& output, io::Existing existing);

} // namespace tread::run
