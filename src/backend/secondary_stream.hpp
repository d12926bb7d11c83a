#pragma once

#include "backend/execution.hpp"

struct CUevent_st; // cudaEvent_t without CUDA's headers

namespace tread
{

/// A second CUDA stream; does nothing on the CPU, where work runs in order. Its blocks start before pending blocks of
/// the first stream.
template<class Exec>
class SecondaryStream;

template<>
class SecondaryStream<Cpu>
{
public:
    explicit SecondaryStream(const Cpu& first)
        : cpu_(first)
    {
    }

    const Cpu& exec() const { return cpu_; }

    /// Makes work launched here from now on wait for all work launched on the first stream so far.
    void fork() {}

    /// Makes work launched on the first stream from now on wait for all work launched here so far.
    void join() {}

private:
    Cpu cpu_;
};

template<>
class SecondaryStream<Gpu>
{
public:
    /// Throws EnvironmentError if the device cannot create another stream.
    explicit SecondaryStream(const Gpu& first);
    ~SecondaryStream();
    SecondaryStream(const SecondaryStream&)            = delete;
    SecondaryStream& operator=(const SecondaryStream&) = delete;

    const Gpu& exec() const { return second_; }
    void       fork();
    void       join();

private:
    Gpu         first_;
    Gpu         second_;
    CUevent_st* reached_ = nullptr; ///< the event that fork and join record on one stream and wait for on the other
};

} // namespace tread
