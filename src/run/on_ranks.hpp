#pragma once

#include <exception>
#include <functional>
#include <memory>

#include "base/communicator.hpp"
#include "base/exit_code.hpp"
#include "base/watchdog.hpp"

namespace tread::run
{

/// Time (s) for which a failed rank waits for the others to fail as well, before it ends the job alone.
inline constexpr double agreement_timeout = 10;

/// Runs a command between the start and the end of HDF5 and MPI; all ranks return its result or the exit code of its
/// error. Rank 0 reports an error that all ranks have; an error of one rank alone is reported by that rank and ends
/// the job.
ExitCode on_ranks(const std::function<ExitCode(const Communicator&)>& command);

/// Ends the job with `error` of this rank if the others do not fail, too, within agreement_timeout: they may wait for
/// it. Call in the handler of an error of a collective call.
void require_all_failed(const Communicator& world, const std::exception& error);

/// Ends the job, with exit code 4, when a rank waits longer than `timeout` (s); each such rank reports it, and in a
/// collective call which ranks of its node have not come to it. Null on one rank. Collective.
std::unique_ptr<Watchdog> watch_ranks(const Communicator& world, double timeout);

} // namespace tread::run
