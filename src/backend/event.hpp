#pragma once

#include "backend/execution.hpp"

struct CUevent_st; // cudaEvent_t without CUDA's headers

namespace tread
{

/// A CUDA event: the host waits until the backend has reached it, while the backend continues with work launched later.
/// Does nothing on the CPU, where all launched work is complete.
template<class Exec>
class Event;

template<>
class Event<Cpu>
{
public:
    explicit Event(const Cpu&) {}

    /// Records the event after all work launched so far.
    void mark() {}

    /// Waits for the event recorded last.
    void wait() const {}
};

template<>
class Event<Gpu>
{
public:
    /// Throws EnvironmentError if the device cannot create the event.
    explicit Event(const Gpu& gpu);
    ~Event();
    Event(const Event&)            = delete;
    Event& operator=(const Event&) = delete;

    void mark();
    void wait() const;

private:
    Gpu         gpu_;
    CUevent_st* event_ = nullptr;
};

} // namespace tread
