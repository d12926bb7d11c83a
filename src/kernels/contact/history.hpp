#pragma once

#include <cstdint>
#include <vector>

#include "backend/array.hpp"
#include "kernels/contact/point_body_kern.hpp"

// Contact history between sand and bodies, found by key (the paper's section 2.4): points change their index in memory
// but keep their id. Records are stored densely in the order of the step's candidates; a hash table of bins holds their
// positions. The bin of a key depends on the insertion order of threads; the record found under a key does not.
namespace tread::contact
{

constexpr int history_body_bits = 28; ///< bits for the body in a key

/// Key of a contact: body below 2^history_body_bits, point id, and sub-id below 15 (0 = the only contact of the point
/// with the body, otherwise the number of a sample, from 1). It is never 0, which marks an empty bin.
TREAD_HD std::uint64_t history_key(std::int32_t body, std::uint32_t point_id, int sub_id = 0)
{
    return static_cast<std::uint64_t>(body) << 36 | static_cast<std::uint64_t>(point_id) << 4 |
           static_cast<std::uint64_t>(sub_id + 1);
}

/// Returns the body of a key.
TREAD_HD std::int64_t body_of(std::uint64_t history_key) { return static_cast<std::int64_t>(history_key >> 36); }

/// Returns the point id of a key.
TREAD_HD std::uint32_t point_of(std::uint64_t history_key) { return static_cast<std::uint32_t>(history_key >> 4); }

/// Hash table of the records. A bin is empty (key 0) or filled; at least half are empty.
struct HistoryView
{
    std::int64_t      bins; ///< a power of two, or 0 without records
    std::uint64_t*    bin_key;
    std::int32_t*     bin_record;
    const Tangential* tangential;
};

/// Memory of HistoryView.
template<class Exec>
struct History
{
    explicit History(const Exec& exec)
        : key(exec, "contact history keys")
        , tangential(exec, "contact history")
        , bin_key(exec, "contact history bin keys")
        , bin_record(exec, "contact history bins")
    {
    }

    HistoryView view() { return {bin_key.size(), bin_key.data(), bin_record.data(), tangential.data()}; }

    Array<Exec, std::uint64_t> key; ///< key of each record
    Array<Exec, Tangential>    tangential;
    Array<Exec, std::uint64_t> bin_key;
    Array<Exec, std::int32_t>  bin_record;
};

/// Allocates memory for `records` and for bins that are at most half full; old records are lost.
template<class Exec>
void resize(History<Exec>& history, std::int64_t records);

/// Makes room for `more` records behind the present ones, which stay; the caller writes them, then fills the bins.
template<class Exec>
void extend(History<Exec>& history, std::int64_t more);

/// Fills the bins from the records, whose keys must differ.
template<class Exec>
void fill_bins(const Exec& exec, History<Exec>& history);

struct HistoryRecord
{
    std::uint64_t key;
    Tangential    tangential;
};

/// Returns all records by ascending key, whatever their order in memory: for a checkpoint or another rank.
template<class Exec>
std::vector<HistoryRecord> read_out(const History<Exec>& history);

/// Replaces all records; any order, but keys must differ.
template<class Exec>
void put_back(const Exec& exec, History<Exec>& history, const std::vector<HistoryRecord>& records);

/// Copies the contact records of points that migrate (ids ascending). The originals stay until the contacts of the step
/// are saved; no point of this rank looks them up.
template<class Exec>
std::vector<HistoryRecord> records_of(const Exec& exec, const History<Exec>& history,
                                      const std::vector<std::uint32_t>& ids);

/// Adds records, whose keys must differ from all present ones.
template<class Exec>
void add_records(const Exec& exec, History<Exec>& history, const std::vector<HistoryRecord>& records);

} // namespace tread::contact
