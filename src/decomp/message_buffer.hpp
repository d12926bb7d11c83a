#pragma once

#include <cstddef>
#include <cstdint>

#include "backend/array.hpp"
#ifdef TREAD_WITH_CUDA
#include "backend/pinned.hpp"
#endif

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
class MessageBuffer;

template<>
class MessageBuffer<Cpu>
{
public:
    MessageBuffer(const Cpu& cpu, const char* name, Carrier)
        : bytes_(cpu, name)
    {
    }

    /// Contents are lost if the buffer has to grow.
    std::byte* reserve(std::int64_t bytes)
    {
        bytes_.resize(bytes);
        return bytes_.data();
    }

    std::byte* data() { return bytes_.data(); }

private:
    Array<Cpu, std::byte> bytes_;
};

#ifdef TREAD_WITH_CUDA
template<>
class MessageBuffer<Gpu>
{
public:
    MessageBuffer(const Gpu& gpu, const char* name, Carrier carrier)
        : carrier_(carrier)
        , device_(gpu, name)
        , pinned_(Pinned{gpu.counters}, name)
    {
    }

    std::byte* reserve(std::int64_t bytes)
    {
        if (carrier_ == Carrier::host) { pinned_.resize(bytes); }
        else { device_.resize(bytes); }
        return data();
    }

    std::byte* data() { return carrier_ == Carrier::host ? pinned_.data() : device_.data(); }

private:
    Carrier                  carrier_;
    Array<Gpu, std::byte>    device_;
    Array<Pinned, std::byte> pinned_;
};
#endif

} // namespace tread::decomp
