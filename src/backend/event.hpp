#pragma once

#include "backend/execution.hpp"

struct CUevent_st; // cudaEvent_t without CUDA's headers

namespace tread
{

/// A moment in a backend's work. The host can wait until it is reached while the backend goes on with what it was given
/// since. A CPU has done all that it was given.
template<class Exec>
class Event;

template<>
class Event<Cpu>
{
public:
    explicit Event(const Cpu&) {}

    /// From now on the moment is the end of all that the backend has been given.
    void mark() {}

    /// Until the moment that was marked last.
    void wait() const {}
};

#ifdef TREAD_WITH_CUDA
template<>
class Event<Gpu>
{
public:
    /// EnvironmentError when the device has no room for it.
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
#endif

} // namespace tread
