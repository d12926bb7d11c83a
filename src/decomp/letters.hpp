#pragma once

#include <cstddef>
#include <cstring>
#include <type_traits>
#include <vector>

#include "base/communicator.hpp"

// What ranks tell each other seldom, from host memory, in any length.
namespace tread::decomp
{

using Letter = std::vector<std::byte>;

/// Collective: letters[r] goes to rank r; returns what every rank had for this one.
std::vector<Letter> exchange_letters(const Communicator& communicator, const std::vector<Letter>& letters);

template<class T>
void write(Letter& letter, const T* values, std::size_t count)
{
    static_assert(std::is_trivially_destructible_v<T>);
    const auto* bytes = reinterpret_cast<const std::byte*>(values);
    letter.insert(letter.end(), bytes, bytes + count * sizeof(T));
}

/// All of a letter that holds values of one type.
template<class T>
std::vector<T> read_all(const Letter& letter)
{
    std::vector<T> values(letter.size() / sizeof(T));
    if (!values.empty()) { std::memcpy(static_cast<void*>(values.data()), letter.data(), letter.size()); }
    return values;
}

/// Collective: values[r], of one type, goes to rank r.
template<class T>
std::vector<std::vector<T>> exchange_values(const Communicator& communicator, const std::vector<std::vector<T>>& values)
{
    std::vector<Letter> letters(values.size());
    for (std::size_t r = 0; r < values.size(); ++r) { write(letters[r], values[r].data(), values[r].size()); }
    std::vector<std::vector<T>> found;
    for (const Letter& letter : exchange_letters(communicator, letters)) { found.push_back(read_all<T>(letter)); }
    return found;
}

/// Collective: the values of every rank, in rank order.
template<class T>
std::vector<std::vector<T>> gather_values(const Communicator& communicator, const std::vector<T>& values)
{
    return exchange_values(communicator,
                           std::vector<std::vector<T>>(static_cast<std::size_t>(communicator.size()), values));
}

} // namespace tread::decomp
