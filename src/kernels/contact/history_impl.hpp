#pragma once

#include <algorithm>
#include <bit>

#include "kernels/contact/history_kern.hpp"

// The steps of the history, the same on both backends; history.cpp and history.cu bring in for_each and instantiate.
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

} // namespace history_steps

template<class Exec>
void resize(History<Exec>& history, std::int64_t records)
{
    const std::int64_t bins =
        records == 0 ? 0 : static_cast<std::int64_t>(std::bit_ceil(2 * static_cast<std::uint64_t>(records)));
    history.key.resize(records);
    history.tangential.resize(records);
    history.bin_key.resize(bins);
    history.bin_record.resize(bins);
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

} // namespace tread::contact
