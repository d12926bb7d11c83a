#pragma once

#include "backend/instantiate.hpp"
#include "decomp/rows.hpp"

// Packing and unpacking for both backends; rows.cpp and rows.cu provide for_each.
namespace tread::decomp
{

/// Four bytes of any type.
using Word = std::uint32_t __attribute__((may_alias));

/// Address of one word of a packed row in the columns.
struct Spot
{
    std::byte*   at;
    std::int32_t bytes; ///< 1 or 4
};

TREAD_HD Spot spot_of(const Columns& columns, std::int64_t row, std::int32_t word)
{
    int c = 0;
    while (word >= columns.at[c].words()) { word -= columns.at[c++].words(); }
    const Column&      column = columns.at[c];
    const int          half   = column.bytes == 8 ? word & 1 : 0;
    const std::int32_t value  = column.bytes == 8 ? word >> 1 : word;
    return {column.data + (row * column.row_step + value * column.value_step) * column.bytes + 4 * half,
            column.bytes == 1 ? 1 : 4};
}

struct PackWord
{
    Columns             columns;
    const std::int32_t* index;
    std::uint32_t*      to;

    TREAD_HD void operator()(std::int64_t i) const
    {
        const std::int64_t k    = i / columns.words;
        const Spot         from = spot_of(columns, index[k], static_cast<std::int32_t>(i - k * columns.words));
        *reinterpret_cast<Word*>(to + i) =
            from.bytes == 1 ? static_cast<std::uint32_t>(*from.at) : *reinterpret_cast<const Word*>(from.at);
    }
};

struct UnpackWord
{
    Columns              columns;
    const std::int32_t*  index;
    std::int64_t         first;
    const std::uint32_t* from;

    TREAD_HD void operator()(std::int64_t i) const
    {
        const std::int64_t k   = i / columns.words;
        const std::int64_t row = index == nullptr ? first + k : index[k];
        const Spot         to  = spot_of(columns, row, static_cast<std::int32_t>(i - k * columns.words));
        if (to.bytes == 1) { *to.at = static_cast<std::byte>(from[i]); }
        else { *reinterpret_cast<Word*>(to.at) = from[i]; }
    }
};

template<class Exec>
void pack_rows(const Exec& exec, const Columns& columns, const std::int32_t* index, std::int64_t count,
               std::uint32_t* to)
{
    for_each(exec, "pack rows", count * columns.words, PackWord{columns, index, to});
}

template<class Exec>
void unpack_rows(const Exec& exec, const std::uint32_t* from, std::int64_t count, const Columns& columns,
                 const std::int32_t* index, std::int64_t first)
{
    for_each(exec, "unpack rows", count * columns.words, UnpackWord{columns, index, first, from});
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template void pack_rows(const Exec&, const Columns&, const std::int32_t*, std::int64_t, std::uint32_t*);           \
    template void unpack_rows(const Exec&, const std::uint32_t*, std::int64_t, const Columns&, const std::int32_t*,    \
                              std::int64_t)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::decomp
