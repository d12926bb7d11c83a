#pragma once

#include "backend/array.hpp"
#ifdef TREAD_WITH_CUDA
#include "backend/pinned.hpp"
#endif

namespace tread
{

/// Returns the host's tag of a backend: its arrays receive asynchronous copies (pinned memory for a GPU).
inline Cpu host_side(const Cpu& cpu) { return cpu; }
#ifdef TREAD_WITH_CUDA
inline Pinned host_side(const Gpu& gpu) { return {gpu.counters}; }
#endif

/// Asynchronous copy of one value to the host. Several requested copies share one synchronization.
template<class Exec, class T>
class AsyncReadback
{
public:
    AsyncReadback(const Exec& exec, const char* name)
        : exec_(exec)
        , value_(host_side(exec), name, 1)
    {
    }

    /// Enqueues a copy of the value at `from`, as it will be when the backend reaches this point of its stream.
    void request(const T* from) { start_copy_to_host(exec_, value_.data(), from, sizeof(T)); }

    /// Returns the value requested last; valid after synchronize(exec).
    const T& get() const { return *value_.data(); }

private:
    Exec                                                exec_;
    Array<decltype(host_side(std::declval<Exec>())), T> value_;
};

} // namespace tread
