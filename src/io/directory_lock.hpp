#pragma once

#include <memory>
#include <string>

#include "base/communicator.hpp"

namespace tread::io
{

inline constexpr const char* lock_file = ".lock";

/// Whether a directory has the lock of a run, which says so, and not somebody's file of that name.
bool has_lock_of_run(const std::string& directory);

/// Keeps other runs out of a directory while it or a copy lives; the kernel takes the lock back when the process ends,
/// however that happens. Held by rank 0 through the file `.lock`, which says whose it is and stays.
class DirectoryLock
{
public:
    /// Collective. The directory must be there. EnvironmentError if another process has it; InputError where a file
    /// `.lock` is somebody else's, or a link.
    DirectoryLock(const Communicator& communicator, const std::string& directory);

private:
    class Held;
    std::shared_ptr<const Held> held_; ///< on rank 0
};

} // namespace tread::io
