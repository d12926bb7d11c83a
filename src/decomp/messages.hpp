#pragma once

#include <cstddef>
#include <cstring>
#include <type_traits>
#include <vector>

#include "base/communicator.hpp"

// Occasional messages between ranks, in host memory and of any length.
namespace tread::decomp
{

using Message = std::vector<std::byte>;

/// Sends messages[r] to rank r; returns the message of every rank to this one. Collective.
std::vector<Message> exchange_messages(const Communicator& communicator, const std::vector<Message>& messages);

template<class T>
void write(Message& message, const T* values, std::size_t count)
{
    static_assert(std::is_trivially_destructible_v<T>);
    const auto* bytes = reinterpret_cast<const std::byte*>(values);
    message.insert(message.end(), bytes, bytes + count * sizeof(T));
}

/// Returns the whole content of a message that holds values of one type.
template<class T>
std::vector<T> read_all(const Message& message)
{
    std::vector<T> values(message.size() / sizeof(T));
    if (!values.empty()) { std::memcpy(static_cast<void*>(values.data()), message.data(), message.size()); }
    return values;
}

/// Sends values[r], of one type, to rank r; returns the values of every rank for this one. Collective.
template<class T>
std::vector<std::vector<T>> exchange_values(const Communicator& communicator, const std::vector<std::vector<T>>& values)
{
    std::vector<Message> messages(values.size());
    for (std::size_t r = 0; r < values.size(); ++r) { write(messages[r], values[r].data(), values[r].size()); }
    std::vector<std::vector<T>> found;
    for (const Message& message : exchange_messages(communicator, messages)) { found.push_back(read_all<T>(message)); }
    return found;
}

/// Gathers the values of every rank, in rank order. Collective.
template<class T>
std::vector<std::vector<T>> gather_values(const Communicator& communicator, const std::vector<T>& values)
{
    return exchange_values(communicator,
                           std::vector<std::vector<T>>(static_cast<std::size_t>(communicator.size()), values));
}

} // namespace tread::decomp
