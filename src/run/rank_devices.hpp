#pragma once

#include <string>
#include <vector>

#include "base/log.hpp"
#include "run/run_scene.hpp"

// Which rank computes on which GPU. Only in builds with a CUDA compiler (TREAD_WITH_CUDA).
namespace tread::run
{

/// Collective: the device of this rank: the ranks of a machine take in turn the devices that each of them sees.
/// EnvironmentError, on all ranks, where two come to the same device and `sharing` does not allow that.
int device_of_rank(const Communicator& communicator, GpuSharing sharing);

/// Collective: every rank's device by name, and, on several ranks, a line each to the log with rank, host and device.
std::vector<std::string> say_devices(const Communicator& communicator, Log& log, int device);

} // namespace tread::run
