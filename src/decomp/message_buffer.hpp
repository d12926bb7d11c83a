#pragma once

#include <cstddef>
#include <cstdint>

#include "backend/array.hpp"
#ifdef TREAD_WITH_CUDA
#include "backend/pinned.hpp"
#endif

namespace tread::decomp
{

/// What carries bytes from rank to rank.
enum class Carrier
{
    mpi,  ///< MPI, from and to the backend's own memory
    nccl, ///< NCCL, the same
    host  ///< MPI, from and to host memory that kernels of the GPU write and read
};

/// Memory that kernels and the carrier both reach; grows only.
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

    /// Old bytes are lost when it has to grow.
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
