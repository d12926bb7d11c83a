#pragma once

#include <cstdint>
#include <vector>

#include "backend/array.hpp"
#include "kernels/contact/point_body_kern.hpp"

// What sand-body contacts remember from step to step, found by key (the paper's section 2.4): points change their place
// in memory, not their id. Records stand dense, in the order of the step's candidates; bins, claimed by hashing, say
// where. Which bin a key got depends on who came first, what is found under it does not.
namespace tread::contact
{

constexpr int history_body_bits = 28; ///< of a key

/// Key of a contact: body under 2^history_body_bits, point id, sub-id under 15 (0 = the point's only contact with the
/// body, else a sample's number from 1). Never 0, which marks an empty bin.
TREAD_HD std::uint64_t history_key(std::int32_t body, std::uint32_t point_id, int sub_id = 0)
{
    return static_cast<std::uint64_t>(body) << 36 | static_cast<std::uint64_t>(point_id) << 4 |
           static_cast<std::uint64_t>(sub_id + 1);
}

/// Of a key.
TREAD_HD std::uint32_t point_of(std::uint64_t history_key) { return static_cast<std::uint32_t>(history_key >> 4); }

/// Where the records stand. A bin is empty (key 0) or filled; at least half are empty.
struct HistoryView
{
    std::int64_t      bins; ///< a power of two, or 0: no records
    std::uint64_t*    bin_key;
    std::int32_t*     bin_record;
    const Tangential* tangential;
};

/// Owner of what HistoryView shows.
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

    Array<Exec, std::uint64_t> key; ///< of each record
    Array<Exec, Tangential>    tangential;
    Array<Exec, std::uint64_t> bin_key;
    Array<Exec, std::int32_t>  bin_record;
};

/// Memory for `records`, and for bins that they fill by at most half; old records are lost.
template<class Exec>
void resize(History<Exec>& history, std::int64_t records);

/// Bins for the records, whose keys must differ.
template<class Exec>
void fill_bins(const Exec& exec, History<Exec>& history);

struct HistoryRecord
{
    std::uint64_t key;
    Tangential    tangential;
};

/// All records by ascending key, whatever order they stand in: for a checkpoint, or another rank.
template<class Exec>
std::vector<HistoryRecord> read_out(const History<Exec>& history);

/// Replaces all records, in any order; their keys must differ.
template<class Exec>
void put_back(const Exec& exec, History<Exec>& history, const std::vector<HistoryRecord>& records);

/// Those of the points with these ids (ascending): what is to go where such points go. They stay here too, until the
/// step's contacts are saved; no point of this rank asks for them.
template<class Exec>
std::vector<HistoryRecord> records_of(const Exec& exec, const History<Exec>& history,
                                      const std::vector<std::uint32_t>& ids);

/// Adds records, whose keys must differ from all that are there.
template<class Exec>
void add_records(const Exec& exec, History<Exec>& history, const std::vector<HistoryRecord>& records);

} // namespace tread::contact
