#pragma once

#include <memory>
#include <string>

#include "base/communicator.hpp"

namespace tread::io
{

inline constexpr const char* lock_file = ".lock";

/// Keeps other runs out of a directory while it or a copy lives; the kernel takes the lock back when the process ends,
/// however that happens. Held by rank 0 through the file `.lock`, which says whose it is and stays.
class DirectoryLock
{
public:
    /// Collective. EnvironmentError if another process has it; the directory must be there.
    DirectoryLock(const Communicator& communicator, const std::string& directory);

private:
    class Held;
    std::shared_ptr<const Held> held_; ///< on rank 0
};

} // namespace tread::io
