#pragma once

#include "kernels/dem/pairs/pairs_kern.hpp"

// Item functions for keys of pairs whose bodies change rows.
namespace tread::dem::record_steps
{

/// Rows of bodies after others have come or gone.
struct NewRows
{
    std::int64_t        before; ///< number of rows
    std::int64_t        now;    ///< likewise
    const std::int32_t* row;    ///< [before]; negative: gone

    /// Returns the row of a body or, after all of them, of a wall.
    TREAD_HD std::int64_t operator()(std::int64_t side) const
    {
        return side < before ? row[side] : side - before + now;
    }
};

struct IsLeft
{
    NewRows              rows;
    const std::uint64_t* key;

    TREAD_HD bool operator()(std::int64_t p) const
    {
        return rows(first_of(key[p])) >= 0 && rows(second_of(key[p])) >= 0;
    }
};

struct Renumber
{
    NewRows        rows;
    std::uint64_t* key;

    TREAD_HD void operator()(std::int64_t p) const
    {
        key[p] = pair_key(rows(first_of(key[p])), rows(second_of(key[p]))) + patch_number(key[p]);
    }
};

} // namespace tread::dem::record_steps
