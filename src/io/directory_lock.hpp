#pragma once

#include <memory>
#include <string>

#include "base/communicator.hpp"

namespace tread::io
{

inline constexpr const char* lock_file = ".lock";

/// Whether a directory holds a run's lock, which identifies itself, and not an unrelated file of that name.
bool has_lock_of_run(const std::string& directory);

/// Excludes other runs from a directory while it or a copy lives; the kernel releases the lock when the process ends,
/// however that happens. Rank 0 holds it through the file `.lock`, which names the holder and is never deleted.
class DirectoryLock
{
public:
    /// Collective. The directory must exist. EnvironmentError if another process holds the lock; InputError if `.lock`
    /// is an unrelated file or a link.
    DirectoryLock(const Communicator& communicator, const std::string& directory);

private:
    class Held;
    std::shared_ptr<const Held> held_; ///< on rank 0
};

} // namespace tread::io
