#pragma once

#include <cstdint>

#include "backend/array.hpp"
#include "backend/sort.hpp"

// Runs of equal keys in a sorted list: the candidates of each body, the candidates of each point.
namespace tread::contact
{

struct RunsView
{
    std::int64_t        count;
    const std::int32_t* key;   ///< [count], ascending
    const std::int32_t* first; ///< [count + 1], places in the sorted list
};

/// Owner of what RunsView shows.
template<class Exec>
struct Runs
{
    Runs(const Exec& exec, const char* key_name, const char* first_name)
        : key(exec, key_name)
        , first(exec, first_name)
    {
    }

    RunsView view() const { return {key.size(), key.data(), first.data()}; }

    Array<Exec, std::int32_t> key;
    Array<Exec, std::int32_t> first;
};

/// Last index in [0, count) with first[index] <= item, for ascending `first` with first[0] = 0: the owner of an item
/// in a list that was flattened by an exclusive scan. Owners without items are passed over.
TREAD_HD std::int64_t owner_of(const std::int32_t* first, std::int64_t count, std::int64_t item)
{
    return lower_bound(first, count, static_cast<std::int32_t>(item + 1)) - 1;
}

namespace run_steps
{

struct MarkHeads
{
    const std::int32_t* keys;
    std::int64_t        count;
    std::int32_t*       marks; ///< [count + 1]

    TREAD_HD void operator()(std::int64_t i) const { marks[i] = i < count && (i == 0 || keys[i] != keys[i - 1]); }
};

/// After the scan marks[i] counts the heads before i.
struct WriteRuns
{
    const std::int32_t* keys;
    std::int64_t        count;
    const std::int32_t* heads_before;
    std::int32_t*       key;
    std::int32_t*       first;

    TREAD_HD void operator()(std::int64_t i) const
    {
        const std::int32_t run = heads_before[i];
        if (i == count) { first[run] = static_cast<std::int32_t>(count); }
        else if (heads_before[i + 1] != run)
        {
            key[run]   = keys[i];
            first[run] = static_cast<std::int32_t>(i);
        }
    }
};

} // namespace run_steps

/// Runs of equal values in `keys`, sorted, of which there is at least one. After the call marks[i + 1] - 1 is the run
/// of item i.
template<class Exec>
void find_runs(const Exec& exec, const Array<Exec, std::int32_t>& keys, Array<Exec, std::int32_t>& marks,
               Runs<Exec>& runs, SortScratch<Exec>& scratch)
{
    const std::int64_t count = keys.size();
    marks.resize(count + 1);
    for_each(exec, "mark runs", count + 1, run_steps::MarkHeads{keys.data(), count, marks.data()});
    const std::int64_t found = exclusive_scan(exec, marks, scratch);
    runs.key.resize(found);
    runs.first.resize(found + 1);
    for_each(exec, "write runs", count + 1,
             run_steps::WriteRuns{keys.data(), count, marks.data(), runs.key.data(), runs.first.data()});
}

} // namespace tread::contact
