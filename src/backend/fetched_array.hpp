#pragma once

#include "backend/async_readback.hpp"

namespace tread
{

/// An array of a backend's memory on its way to the host, into memory that is kept for the next time: several that are
/// asked for together cost one wait, and on a GPU they go into pinned memory.
template<class Exec, class T>
class FetchedArray
{
public:
    FetchedArray(const Exec& exec, const char* name)
        : exec_(exec)
        , values_(host_side(exec), name)
    {
    }

    /// Asks for what will be in `from` when the backend gets there.
    void request(const Array<Exec, T>& from)
    {
        values_.resize(from.size());
        start_copy_to_host(exec_, values_.data(), from.data(), static_cast<std::size_t>(from.size()) * sizeof(T));
    }

    /// What was asked for last; after synchronize(exec).
    const T* data() const { return values_.data(); }

private:
    Exec                                                exec_;
    Array<decltype(host_side(std::declval<Exec>())), T> values_;
};

} // namespace tread
