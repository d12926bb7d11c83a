#pragma once

#include <string>
#include <vector>

#include "base/log.hpp"
#include "run/run_scene.hpp"

// Assignment of GPUs to ranks. Only in builds with a CUDA compiler (TREAD_WITH_CUDA).
namespace tread::run
{

/// Collective: the device of this rank; the ranks of a machine use the devices visible to them in turn.
/// EnvironmentError, on all ranks, where two get the same device and `sharing` does not allow that.
int device_of_rank(const Communicator& communicator, GpuSharing sharing);

/// Collective: names every rank's device; on several ranks it also logs a line for each with rank, host and device.
std::vector<std::string> log_devices(const Communicator& communicator, Log& log, int device);

} // namespace tread::run
