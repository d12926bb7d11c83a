#pragma once

namespace tread
{

/// What the process returns; jobs decide from it whether to retry, requeue or give up.
enum class ExitCode : int
{
    finished      = 0,
    bad_input     = 2,  ///< scene or arguments are wrong; nothing was written
    numerical     = 3,  ///< the run was stopped with a diagnosis
    environment   = 4,  ///< no GPU, no disk, MPI set up wrongly
    stopped_early = 75, ///< a signal or the wall-time limit; restartable
};

} // namespace tread
