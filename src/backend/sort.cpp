#include "backend/sort.hpp"
#include "backend/count_limit.hpp"

#include <algorithm>
#include <numeric>

namespace tread
{

void sort_by_key(const Cpu& cpu, Array<Cpu, std::uint64_t>& keys, Array<Cpu, std::int32_t>& values,
                 SortScratch<Cpu>& scratch, int)
{
    cpu.counters->launched("sort");
    const std::int64_t n = keys.size();
    if (std::is_sorted(keys.data(), keys.data() + n)) { return; }

    struct Entry
    {
        std::uint64_t key;
        std::int32_t  order;
        std::int32_t  value;
    };
    scratch.bytes.resize(n * static_cast<std::int64_t>(sizeof(Entry)));
    auto* entries = reinterpret_cast<Entry*>(scratch.bytes.data());
    for (std::int64_t i = 0; i < n; ++i)
    {
        entries[i] = {keys.data()[i], static_cast<std::int32_t>(i), values.data()[i]};
    }
    std::sort(entries, entries + n,
              [](const Entry& a, const Entry& b) { return a.key != b.key ? a.key < b.key : a.order < b.order; });
    for (std::int64_t i = 0; i < n; ++i)
    {
        keys.data()[i]   = entries[i].key;
        values.data()[i] = entries[i].value;
    }
}

void scan_in_place(const Cpu& cpu, Array<Cpu, std::int32_t>& values, SortScratch<Cpu>&)
{
    cpu.counters->launched("scan");
    std::exclusive_scan(values.data(), values.data() + values.size(), values.data(), 0);
}

std::int64_t exclusive_scan(const Cpu& cpu, Array<Cpu, std::int32_t>& values, SortScratch<Cpu>& scratch)
{
    const std::int64_t n = values.size();
    if (n == 0) { return 0; }
    const std::int64_t sum = std::accumulate(values.data(), values.data() + n, std::int64_t{0});
    require_countable(sum);
    scan_in_place(cpu, values, scratch);
    return sum;
}

} // namespace tread
