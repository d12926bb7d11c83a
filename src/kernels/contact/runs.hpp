#pragma once

#include <cstdint>

#include "backend/array.hpp"
#include "backend/sort.hpp"

// Runs of equal keys in a sorted list, such as the candidates of each body or of each point.
namespace tread::contact
{

struct RunsView
{
    std::int64_t        count;
    const std::int32_t* key;   ///< [count], ascending
    const std::int32_t* first; ///< [count + 1], indices into the sorted list
};

/// Memory of RunsView.
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

/// Last index in [0, count) with first[index] <= item, for ascending `first` with first[0] = 0: the owner of an item in
/// a list flattened by an exclusive scan. Owners without items are skipped.
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

/// Writes the runs; after the scan marks[i] is the number of run heads before i.
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

/// Finds the runs of equal values in `keys`, which is sorted and not empty. Afterwards marks[i + 1] - 1 is the run of
/// item i.
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

/// Number of chunks of `size` items each, of which the last may have fewer.
inline std::int64_t chunks_of(std::int64_t count, std::int64_t size) { return (count + size - 1) / size; }

/// Maximum number of items in a part. Long runs are summed in parts, so that a body with very many contacts does not
/// occupy a single thread or block; on a GPU as many lanes share a part. Most rocks have fewer contacts than that.
constexpr std::int32_t part_items = 32;
constexpr int          part_lanes = 16;

/// Parts of runs: an item range for each part and a range of parts for each run.
template<class Exec>
struct Parts
{
    explicit Parts(const Exec& exec)
        : of_items(exec, "contact part run", "contact part first item")
        , first_of_run(exec, "contact run first part")
    {
    }

    Runs<Exec>                of_items;
    Array<Exec, std::int32_t> first_of_run;
};

namespace run_steps
{

struct CountParts
{
    RunsView      runs;
    std::int32_t* count; ///< [runs + 1]

    TREAD_HD void operator()(std::int64_t r) const
    {
        count[r] = r < runs.count ? (runs.first[r + 1] - runs.first[r] + part_items - 1) / part_items : 0;
    }
};

struct WriteParts
{
    RunsView            runs;
    const std::int32_t* first_of_run; ///< [runs + 1]
    std::int64_t        parts;
    std::int32_t*       run;
    std::int32_t*       first; ///< [parts + 1]

    TREAD_HD void operator()(std::int64_t p) const
    {
        if (p == parts)
        {
            first[p] = runs.first[runs.count];
            return;
        }
        const auto r = static_cast<std::int32_t>(owner_of(first_of_run, runs.count, p));
        run[p]       = r;
        first[p]     = runs.first[r] + (static_cast<std::int32_t>(p) - first_of_run[r]) * part_items;
    }
};

} // namespace run_steps

/// Divides runs into parts; there must be at least one run.
template<class Exec>
void split_runs(const Exec& exec, const RunsView& runs, Parts<Exec>& parts, SortScratch<Exec>& scratch)
{
    parts.first_of_run.resize(runs.count + 1);
    for_each(exec, "count parts", runs.count + 1, run_steps::CountParts{runs, parts.first_of_run.data()});
    const std::int64_t count = exclusive_scan(exec, parts.first_of_run, scratch);
    parts.of_items.key.resize(count);
    parts.of_items.first.resize(count + 1);
    for_each(exec, "write parts", count + 1,
             run_steps::WriteParts{runs, parts.first_of_run.data(), count, parts.of_items.key.data(),
                                   parts.of_items.first.data()});
}

} // namespace tread::contact
