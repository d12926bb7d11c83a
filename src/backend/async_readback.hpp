#pragma once

#include "backend/array.hpp"
#include "backend/pinned.hpp"

namespace tread
{

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
    Exec                     exec_;
    Array<HostSide<Exec>, T> value_;
};

} // namespace tread
