#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "backend/execution.hpp"
#include "base/communicator.hpp"
#include "decomp/message_range.hpp"

// NCCL, opened at run time on request, so that no build depends on it.
namespace tread::decomp
{

struct NcclLibrary;

class Nccl
{
public:
    /// Collective. EnvironmentError with the reason, on all ranks, if some rank has no libnccl.so.2 or NCCL does not
    /// start (two ranks on one GPU, for example).
    explicit Nccl(const Communicator& communicator);
    ~Nccl();
    Nccl(const Nccl&)            = delete;
    Nccl& operator=(const Nccl&) = delete;

    /// Enqueues sends and receives on the device's stream, in order with kernels launched before and after.
    void exchange(const Gpu& gpu, const MessageRanges& out, const std::byte* from, const MessageRanges& in,
                  std::byte* to);

    /// Enqueues the replacement of a number in the device's memory by the largest of all ranks.
    void largest(const Gpu& gpu, std::int32_t* number);

private:
    std::unique_ptr<NcclLibrary> library_;
    void*                        native_ = nullptr; ///< ncclComm_t
};

} // namespace tread::decomp
