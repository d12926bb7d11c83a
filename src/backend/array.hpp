#pragma once

#include <algorithm>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include "backend/counters.hpp"
#include "backend/memory.hpp"

namespace tread
{

/// Array of n values of T in the memory of a backend, which it owns. Grows by a quarter more than requested and shrinks
/// only in fit. Every allocation is counted under the array's name.
template<class Exec, class T>
class Array
{
    static_assert(std::is_trivially_copyable_v<T> || std::is_trivially_destructible_v<T>);

public:
    Array(const Exec& exec, const char* name, std::int64_t size = 0)
        : exec_(exec)
        , name_(name)
    {
        resize(size);
    }

    Array(const Array&)            = delete;
    Array& operator=(const Array&) = delete;

    Array(Array&& other) noexcept
        : exec_(other.exec_)
        , name_(other.name_)
        , data_(std::exchange(other.data_, nullptr))
        , size_(std::exchange(other.size_, 0))
        , capacity_(std::exchange(other.capacity_, 0))
    {
    }

    Array& operator=(Array&& other) noexcept
    {
        swap(other);
        return *this;
    }

    ~Array() { free(); }

    T*           data() { return data_; }
    const T*     data() const { return data_; }
    std::int64_t size() const { return size_; }
    std::int64_t capacity() const { return capacity_; }
    const Exec&  exec() const { return exec_; }
    const char*  name() const { return name_; }

    /// Resizes without keeping values: old ones are lost if the array has to grow, new ones are not initialised.
    void resize(std::int64_t size)
    {
        if (size > capacity_)
        {
            free();
            take(capacity_ == 0 && size_ == 0 ? size : size + size / 4);
        }
        size_ = size;
    }

    /// Resizes without keeping values and releases memory if more than half of it would be unused.
    void fit(std::int64_t size)
    {
        if (2 * (size + size / 4) < capacity_) { free(); }
        resize(size);
    }

    /// Resizes and keeps the old values; new ones are not initialised.
    void resize_keep(std::int64_t size)
    {
        if (size > capacity_)
        {
            Array larger(exec_, name_);
            larger.take(size + size / 4);
            copy(exec_, larger.data_, data_, bytes(size_));
            swap(larger);
        }
        size_ = size;
    }

    void fill_zero() { tread::fill_zero(exec_, data_, bytes(size_)); }

    void assign(const std::vector<T>& values)
    {
        resize(static_cast<std::int64_t>(values.size()));
        copy_from_host(exec_, data_, values.data(), bytes(size_));
    }

    std::vector<T> to_host() const
    {
        std::vector<T> values(static_cast<std::size_t>(size_));
        copy_to_host(exec_, values.data(), data_, bytes(size_));
        return values;
    }

    void swap(Array& other) noexcept
    {
        std::swap(name_, other.name_);
        std::swap(data_, other.data_);
        std::swap(size_, other.size_);
        std::swap(capacity_, other.capacity_);
    }

private:
    static std::size_t bytes(std::int64_t count) { return static_cast<std::size_t>(count) * sizeof(T); }

    void take(std::int64_t capacity)
    {
        if (capacity == 0) { return; }
        data_     = static_cast<T*>(allocate(exec_, name_, bytes(capacity)));
        capacity_ = capacity;
        exec_.counters->allocated(name_, static_cast<std::int64_t>(bytes(capacity)));
    }

    void free()
    {
        if (data_ == nullptr) { return; }
        release(exec_, data_);
        exec_.counters->freed(name_, static_cast<std::int64_t>(bytes(capacity_)));
        data_     = nullptr;
        capacity_ = 0;
    }

    Exec         exec_;
    const char*  name_;
    T*           data_     = nullptr;
    std::int64_t size_     = 0;
    std::int64_t capacity_ = 0;
};

/// Reads one value from a backend's memory; waits for the copy.
template<class Exec, class T>
T read(const Exec& exec, const T* at)
{
    T value;
    copy_to_host(exec, &value, at, sizeof(T));
    return value;
}

} // namespace tread
