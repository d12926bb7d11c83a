#pragma once

#include "backend/array.hpp"
#ifdef TREAD_WITH_CUDA
#include "backend/pinned.hpp"
#endif

namespace tread
{

/// The host's side of a backend: memory that its copies reach while the host goes on.
inline Cpu host_side(const Cpu& cpu) { return cpu; }
#ifdef TREAD_WITH_CUDA
inline Pinned host_side(const Gpu& gpu) { return {gpu.counters}; }
#endif

/// A value of a backend's memory on its way to the host: several that are asked for together cost one wait.
template<class Exec, class T>
class AsyncReadback
{
public:
    AsyncReadback(const Exec& exec, const char* name)
        : exec_(exec)
        , value_(host_side(exec), name, 1)
    {
    }

    /// Asks for what will be at `from` when the backend gets there.
    void request(const T* from) { start_copy_to_host(exec_, value_.data(), from, sizeof(T)); }

    /// What was asked for last; after synchronize(exec).
    const T& get() const { return *value_.data(); }

private:
    Exec                                                exec_;
    Array<decltype(host_side(std::declval<Exec>())), T> value_;
};

} // namespace tread
