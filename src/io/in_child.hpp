#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace tread::io
{

/// Resource limits of a child process.
struct ChildLimits
{
    int          busy  = 10;                    ///< s, of processor time
    int          wall  = 60;                    ///< s: disks may be slow
    std::int64_t bytes = std::int64_t{1} << 30; ///< of memory beyond that of this process
    std::size_t  text  = std::size_t{64} << 20; ///< of the answer
};

/// Runs `work` in a forked child and returns its text, so that a library that crashes, loops or exhausts memory on a
/// damaged file ends only the child. An Error thrown there is rethrown here as an EnvironmentError, as is a child's end
/// by a signal or a limit. `what`: prefix of that error ("run.h5: reading it").
std::string run_in_child(const std::string& what, const std::function<std::string()>& work,
                         const ChildLimits& limits = {});

} // namespace tread::io
