#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "io/run_directory.hpp"
#include "scene/scene.hpp"

namespace tread::run
{

/// Whether and from where a run continues an earlier one.
enum class RestartMode
{
    none,
    automatic, ///< from the newest usable checkpoint in the run directory; from the start if there is none
    file
};

struct RestartOptions
{
    RestartMode mode = RestartMode::none;
    std::string file;
};

/// How to start the run.
struct RestartPlan
{
    bool                     finished = false; ///< nothing is left to compute
    std::string              checkpoint;       ///< checkpoint to continue from; empty = from the start
    io::Existing             existing = io::Existing::refuse;
    std::vector<std::string> remarks; ///< for the log: checkpoints that were skipped, and why

    std::optional<io::DirectoryLock> lock; ///< lock of the directory, if it already held a run
};

/// Collective. Throws InputError when the scene differs from the one to continue (every difference is named), or when
/// --overwrite contradicts the restart; EnvironmentError when checkpoints exist and none is usable, or another process
/// is using the directory.
RestartPlan plan_restart(const Communicator& communicator, const scene::Scene& scene, const RestartOptions& options,
                         const std::string& output, io::Existing existing);

} // namespace tread::run
