#include "backend/device.hpp"
#include "base/errors.hpp"

#ifndef TREAD_WITH_CUDA
namespace tread
{
namespace
{

const char* no_gpu_backend = "this build has no GPU backend (no CUDA compiler was found when it was made)";

} // namespace

int device_count() { return 0; }

DeviceFacts device_facts(int) { throw EnvironmentError(no_gpu_backend); }

Device::Device(int, Counters& counters)
    : gpu_{nullptr, &counters}
{
    throw EnvironmentError(no_gpu_backend);
}

Device::~Device() = default;

} // namespace tread
#endif
