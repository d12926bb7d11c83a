#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <type_traits>

#include "backend/execution.hpp"

// Packs rows of several arrays beside each other into messages, and unpacks them.
namespace tread::decomp
{

/// One array as rows of `count` values of `bytes` (1, 4 or 8) each: value c of row r is number
/// r * row_step + c * value_step.
struct Column
{
    std::byte*   data;
    std::int64_t row_step;
    std::int64_t value_step;
    std::int32_t bytes;
    std::int32_t count;

    /// Words of 4 bytes in a packed row.
    TREAD_HD std::int32_t words() const { return bytes == 8 ? 2 * count : count; }
};

/// Column of rows of `length` contiguous structs.
template<class Row>
Column rows(Row* data, int length = 1)
{
    static_assert(std::is_trivially_destructible_v<Row> && sizeof(Row) % 4 == 0);
    const auto words = static_cast<std::int32_t>(sizeof(Row) / 4) * length;
    return {reinterpret_cast<std::byte*>(data), words, 1, 4, words};
}

/// Column of a structure of arrays: component c of row r is data[c * stride + r].
template<class T>
Column planes(T* data, std::int64_t stride, int components)
{
    static_assert(sizeof(T) == 1 || sizeof(T) == 4 || sizeof(T) == 8);
    return {reinterpret_cast<std::byte*>(data), 1, stride, static_cast<std::int32_t>(sizeof(T)), components};
}

constexpr int most_columns = 32;

/// The columns that make up a packed row.
struct Columns
{
    int          count = 0;
    std::int32_t words = 0; ///< of a packed row, 4 bytes each
    Column       at[most_columns];

    void add(const Column& column)
    {
        if (count == most_columns) { throw std::logic_error("a row of more columns than there is room for"); }
        at[count++] = column;
        words += column.words();
    }
};

/// Columns of arrays of structs.
template<class... Row>
Columns columns(Row*... data)
{
    static_assert(sizeof...(Row) <= most_columns);
    Columns all;
    (all.add(rows(data)), ...);
    return all;
}

/// Copies row index[k] of the columns to packed row k.
template<class Exec>
void pack_rows(const Exec& exec, const Columns& columns, const std::int32_t* index, std::int64_t count,
               std::uint32_t* to);

/// Copies packed row k to row index[k] of the columns, or to row first + k if `index` is null. Indices must not repeat.
template<class Exec>
void unpack_rows(const Exec& exec, const std::uint32_t* from, std::int64_t count, const Columns& columns,
                 const std::int32_t* index, std::int64_t first);

} // namespace tread::decomp
