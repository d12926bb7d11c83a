#pragma once

#include <algorithm>
#include <bit>

#include "kernels/contact/history_kern.hpp"
#include "kernels/dem/pairs/select.hpp"

// Steps of the contact history, for both backends; history.cpp and history.cu provide for_each and instantiate.
namespace tread::contact
{
namespace history_steps
{

struct ClaimBin
{
    HistoryView          history;
    const std::uint64_t* key;

    TREAD_HD void operator()(std::int64_t record) const
    {
        claim_bin(history, key[record], static_cast<std::int32_t>(record));
    }
};

struct IsOfPoints
{
    const std::uint64_t* key;
    const std::uint32_t* ids; ///< ascending
    std::int64_t         count;

    TREAD_HD bool operator()(std::int64_t record) const { return find_sorted(ids, count, point_of(key[record])) >= 0; }
};

struct WriteRecord
{
    const std::int32_t*  list;
    const std::uint64_t* key;
    const Tangential*    tangential;
    HistoryRecord*       record;

    TREAD_HD void operator()(std::int64_t i) const { record[i] = {key[list[i]], tangential[list[i]]}; }
};

} // namespace history_steps

template<class Exec>
void resize_bins(History<Exec>& history, std::int64_t records)
{
    const std::int64_t bins =
        records == 0 ? 0 : static_cast<std::int64_t>(std::bit_ceil(2 * static_cast<std::uint64_t>(records)));
    history.bin_key.resize(bins);
    history.bin_record.resize(bins);
}

template<class Exec>
void resize(History<Exec>& history, std::int64_t records)
{
    history.key.resize(records);
    history.tangential.resize(records);
    resize_bins(history, records);
}

template<class Exec>
void extend(History<Exec>& history, std::int64_t more)
{
    const std::int64_t records = history.key.size() + more;
    history.key.resize_keep(records);
    history.tangential.resize_keep(records);
    resize_bins(history, records);
}

template<class Exec>
void fill_bins(const Exec& exec, History<Exec>& history)
{
    if (history.key.size() == 0) { return; }
    history.bin_key.fill_zero();
    for_each(exec, "claim history bins", history.key.size(),
             history_steps::ClaimBin{history.view(), history.key.data()});
}

template<class Exec>
std::vector<HistoryRecord> read_out(const History<Exec>& history)
{
    const auto                 key        = history.key.to_host();
    const auto                 tangential = history.tangential.to_host();
    std::vector<HistoryRecord> records;
    records.reserve(key.size());
    for (std::size_t i = 0; i < key.size(); ++i) { records.push_back({key[i], tangential[i]}); }
    std::sort(records.begin(), records.end(),
              [](const HistoryRecord& a, const HistoryRecord& b) { return a.key < b.key; });
    return records;
}

template<class Exec>
void put_back(const Exec& exec, History<Exec>& history, const std::vector<HistoryRecord>& records)
{
    std::vector<std::uint64_t> key;
    std::vector<Tangential>    tangential;
    key.reserve(records.size());
    tangential.reserve(records.size());
    for (const HistoryRecord& record : records)
    {
        key.push_back(record.key);
        tangential.push_back(record.tangential);
    }
    resize(history, static_cast<std::int64_t>(records.size()));
    if (records.empty()) { return; }
    history.key.assign(key);
    history.tangential.assign(tangential);
    fill_bins(exec, history);
}

template<class Exec>
std::vector<HistoryRecord> records_of(const Exec& exec, const History<Exec>& history,
                                      const std::vector<std::uint32_t>& ids)
{
    if (ids.empty() || history.key.size() == 0) { return {}; }
    Array<Exec, std::uint32_t> wanted(exec, "ids of leaving contacts");
    Array<Exec, std::int32_t>  place(exec, "places of leaving contacts"), list(exec, "leaving contacts");
    Array<Exec, HistoryRecord> records(exec, "records of leaving contacts");
    SortScratch<Exec>          scratch(exec);
    wanted.assign(ids);
    dem::select(exec, "leaving contacts", history.key.size(),
                history_steps::IsOfPoints{history.key.data(), wanted.data(), wanted.size()}, place, scratch, list);
    records.resize(list.size());
    for_each(exec, "records of leaving contacts", list.size(),
             history_steps::WriteRecord{list.data(), history.key.data(), history.tangential.data(), records.data()});
    return records.to_host();
}

template<class Exec>
void add_records(const Exec& exec, History<Exec>& history, const std::vector<HistoryRecord>& records)
{
    if (records.empty()) { return; }
    std::vector<HistoryRecord> all = read_out(history);
    all.insert(all.end(), records.begin(), records.end());
    put_back(exec, history, all);
}

} // namespace tread::contact
