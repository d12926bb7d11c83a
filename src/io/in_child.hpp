#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace tread::io
{

/// What a child process may take.
struct ChildLimits
{
    int          busy  = 10;                    ///< s, of processor time
    int          wall  = 60;                    ///< s: disks may be slow
    std::int64_t bytes = std::int64_t{1} << 30; ///< of memory beyond what this process has
    std::size_t  text  = std::size_t{64} << 20; ///< of the answer
};

/// Runs `work` in a copy of this process and returns the text that it returns: a library that crashes, loops or takes
/// all memory on a damaged file then ends the copy alone. An Error that it throws is thrown here, as an
/// EnvironmentError; so is one that says how the copy ended, if it was by a signal or a limit.
/// `what`: of the error ("run.h5: reading it").
std::string run_in_child(const std::string& what, const std::function<std::string()>& work,
                         const ChildLimits& limits = {});

} // namespace tread::io
