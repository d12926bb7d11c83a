#pragma once

#include "kernels/dem/pairs/pairs.hpp"

// Records of the previous list (Pairs::last) that change ranks with their bodies.
namespace tread::dem
{

/// Records of pairs, ascending by key.
template<class Exec>
struct RecordRows
{
    explicit RecordRows(const Exec& exec)
        : key(exec, "keys of migrating records")
        , patch(exec, "patches of migrating records")
        , rolling(exec, "rolling moments of migrating records")
        , place(exec, "patch places of migrating records")
    {
    }

    Array<Exec, std::uint64_t> key;
    Array<Exec, Patch>         patch;
    Array<Exec, Rolling>       rolling; ///< empty without rolling friction
    Array<Exec, Vec3<double>>  place;   ///< empty where no pair has several patches
};

/// Removes the records that the owners of leaving bodies evaluate, and returns them. `leaving`: per body, negative if
/// it stays. Waits for their number.
template<class Exec>
RecordRows<Exec> take_records(const Exec&, Pairs<Exec>& pairs, const Array<Exec, std::int32_t>& leaving);

/// Adds records, in any order, of pairs that have none here.
template<class Exec>
void add_records(const Exec&, Pairs<Exec>& pairs, const RecordRows<Exec>& arriving);

/// Gives the bodies of all records their rows after others have come or gone; records of a body that has gone are
/// dropped. `row`: of each body's row before, its present row, ascending; negative: gone. `rows`: number of rows now.
template<class Exec>
void renumber_records(const Exec&, Pairs<Exec>& pairs, const Array<Exec, std::int32_t>& row, std::int64_t rows);

} // namespace tread::dem
