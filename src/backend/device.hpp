#pragma once

#include <cstdint>
#include <string>

#include "backend/execution.hpp"

namespace tread
{

/// Number of devices that this process can use; 0 also if there is no driver, and in builds without GPU backend.
int device_count();

struct DeviceFacts
{
    std::string  name;
    std::string  identity; ///< of the chip, the same in every process
    std::int64_t total_bytes;
    std::int64_t free_bytes;
};

/// Throws EnvironmentError if there is no such device.
DeviceFacts device_facts(int device);

/// Selects `device` for this thread and owns one stream on it. Throws EnvironmentError on failure.
class Device
{
public:
    Device(int device, Counters& counters);
    // Without CUDA there is no stream to destroy: NOLINTNEXTLINE(performance-trivially-destructible)
    ~Device();
    Device(const Device&)            = delete;
    Device& operator=(const Device&) = delete;

    const Gpu& gpu() const { return gpu_; }

private:
    Gpu gpu_;
};

} // namespace tread
