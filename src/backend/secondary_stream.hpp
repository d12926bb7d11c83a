#pragma once

#include "backend/execution.hpp"

struct CUevent_st; // cudaEvent_t without CUDA's headers

namespace tread
{

/// Room for work beside a backend's other work ("the first lane"). On a GPU: a second stream, whose blocks start before
/// those of the first that wait for room. A CPU does one thing after the other, so that both lanes are one.
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

    /// What is launched here from now on comes after all that the first lane has been given.
    void fork() {}

    /// What the first lane is given from now on comes after all that was launched here.
    void join() {}

private:
    Cpu cpu_;
};

#ifdef TREAD_WITH_CUDA
template<>
class SecondaryStream<Gpu>
{
public:
    /// EnvironmentError when the device has no more streams.
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
    CUevent_st* reached_ = nullptr; ///< where one of them was when the other was told to wait
};
#endif

} // namespace tread
