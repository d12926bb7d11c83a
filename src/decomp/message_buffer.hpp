#pragma once

#include <cstddef>
#include <cstdint>

#include "backend/array.hpp"
#include "backend/pinned.hpp"

namespace tread::decomp
{

/// Transfer method for bytes between ranks.
enum class Carrier
{
    mpi,  ///< MPI on the backend's own memory
    nccl, ///< NCCL on the backend's own memory
    host  ///< MPI on host memory that GPU kernels write and read
};

/// Memory accessible to both kernels and the carrier; only grows.
template<class Exec>
class MessageBuffer
{
public:
    MessageBuffer(const Exec& exec, const char* name, Carrier carrier)
        : carrier_(carrier)
        , own_(exec, name)
        , host_(host_side(exec), name)
    {
    }

    /// Contents are lost if the buffer has to grow.
    std::byte* reserve(std::int64_t bytes)
    {
        if (carrier_ == Carrier::host) { host_.resize(bytes); }
        else { own_.resize(bytes); }
        return data();
    }

    std::byte* data() { return carrier_ == Carrier::host ? host_.data() : own_.data(); }

private:
    Carrier                          carrier_;
    Array<Exec, std::byte>           own_;
    Array<HostSide<Exec>, std::byte> host_;
};

} // namespace tread::decomp
