#include "decomp/page_map.hpp"
#include "backend/instantiate.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace tread::decomp
{

template<class Exec>
PageMap<Exec>::PageMap(const Exec& exec)
    : device_key_(exec, "owned pages")
    , device_rank_(exec, "owners of pages")
{
}

template<class Exec>
void PageMap<Exec>::assign(std::vector<std::uint64_t> key, PageRanks rank)
{
    key_  = std::move(key);
    rank_ = std::move(rank);
    device_key_.assign(key_);
    device_rank_.assign(rank_);
    ++changes_;
}

template<class Exec>
void PageMap<Exec>::add(const std::vector<std::uint64_t>& key, const PageRanks& rank)
{
    std::vector<std::uint64_t> all_keys  = key_;
    PageRanks                  all_ranks = rank_;
    all_keys.insert(all_keys.end(), key.begin(), key.end());
    all_ranks.insert(all_ranks.end(), rank.begin(), rank.end());
    std::vector<std::size_t> order(all_keys.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return all_keys[a] < all_keys[b]; });
    std::vector<std::uint64_t> sorted_keys;
    PageRanks                  sorted_ranks;
    for (const std::size_t i : order)
    {
        sorted_keys.push_back(all_keys[i]);
        sorted_ranks.push_back(all_ranks[i]);
    }
    assign(std::move(sorted_keys), std::move(sorted_ranks));
}

template<class Exec>
std::int32_t PageMap<Exec>::owner(std::uint64_t page) const
{
    const auto at = std::lower_bound(key_.begin(), key_.end(), page);
    return at == key_.end() || *at != page ? -1 : rank_[static_cast<std::size_t>(at - key_.begin())];
}

template<class Exec>
mpm::PageOwnersView PageMap<Exec>::view() const
{
    return {device_key_.size(), device_key_.data(), device_rank_.data()};
}

#define TREAD_INSTANTIATE(Exec) template class PageMap<Exec>
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::decomp
