#pragma once

namespace tread
{

/// `n` values that are loaded and stored as one word; n * sizeof(T) must be a power of two.
template<class T, int n>
struct alignas(n * sizeof(T)) Pack
{
    T at[n];
};

} // namespace tread
