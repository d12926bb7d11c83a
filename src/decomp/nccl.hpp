#pragma once

#include <memory>
#include <string>

#include "backend/execution.hpp"
#include "base/communicator.hpp"
#include "decomp/message_range.hpp"

// NCCL, if this machine has it: opened when a run asks for it, so that no build needs it.
namespace tread::decomp
{

struct NcclLibrary;

class Nccl
{
public:
    /// Collective. EnvironmentError, on all ranks, with the reason: no libnccl.so.2 on some rank, or NCCL does not
    /// start there (two ranks on one GPU, for one).
    explicit Nccl(const Communicator& communicator);
    ~Nccl();
    Nccl(const Nccl&)            = delete;
    Nccl& operator=(const Nccl&) = delete;

    /// Sends and receives on the device's stream, after what was launched before and before what is launched later.
    void exchange(const Gpu& gpu, const MessageRanges& out, const std::byte* from, const MessageRanges& in,
                  std::byte* to);

private:
    std::unique_ptr<NcclLibrary> library_;
    void*                        native_ = nullptr; ///< ncclComm_t
};

} // namespace tread::decomp
