#pragma once

namespace tread
{

/// Exit codes of the process; jobs decide from them whether to retry, requeue or give up.
enum class ExitCode : int
{
    finished      = 0,
    bad_input     = 2,  ///< scene or arguments are wrong; nothing was written
    numerical     = 3,  ///< the run was stopped with a diagnosis
    environment   = 4,  ///< no GPU, no disk, MPI set up wrongly
    stopped_early = 75, ///< a signal or the wall-time limit; restartable
};

} // namespace tread
