#pragma once

#include "backend/async_readback.hpp"

namespace tread
{

/// Asynchronous copy of an array to the host, into a buffer that is reused unless it is much too large. Several
/// requested copies share one synchronization; the buffer of a GPU is pinned memory.
template<class Exec, class T>
class FetchedArray
{
public:
    FetchedArray(const Exec& exec, const char* name)
        : exec_(exec)
        , values_(host_side(exec), name)
    {
    }

    /// Enqueues a copy of `from`, as it will be when the backend reaches this point of its stream.
    void request(const Array<Exec, T>& from)
    {
        values_.fit(from.size());
        start_copy_to_host(exec_, values_.data(), from.data(), static_cast<std::size_t>(from.size()) * sizeof(T));
    }

    /// Returns the values requested last; valid after synchronize(exec).
    const T* data() const { return values_.data(); }

private:
    Exec                     exec_;
    Array<HostSide<Exec>, T> values_;
};

} // namespace tread
