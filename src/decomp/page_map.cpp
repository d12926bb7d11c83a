#include "decomp/page_map.hpp"
#include "backend/instantiate.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace tread::decomp
{
namespace
{

std::size_t index_of(const std::vector<std::uint64_t>& keys, std::vector<std::uint64_t>::const_iterator at)
{
    return static_cast<std::size_t>(at - keys.begin());
}

} // namespace

template<class Exec>
PageMap<Exec>::PageMap(const Exec& exec)
    : device_key_(exec, "owned pages")
    , device_rank_(exec, "owners of pages")
{
}

template<class Exec>
void PageMap<Exec>::assign(std::vector<std::uint64_t> key, PageRanks rank)
{
    std::vector<std::uint8_t> sand;
    sand.reserve(key.size());
    auto before = key_.begin();
    for (const std::uint64_t page : key)
    {
        before = std::lower_bound(before, key_.end(), page);
        sand.push_back(before != key_.end() && *before == page ? sand_[index_of(key_, before)] : std::uint8_t{0});
    }
    key_  = std::move(key);
    rank_ = std::move(rank);
    sand_ = std::move(sand);
    share();
}

template<class Exec>
void PageMap<Exec>::enter_sand(const std::vector<std::uint64_t>& key, const PageRanks& rank)
{
    std::vector<std::uint64_t> all;
    all.reserve(key_.size() + key.size());
    std::set_union(key_.begin(), key_.end(), key.begin(), key.end(), std::back_inserter(all));
    PageRanks                 ranks;
    std::vector<std::uint8_t> sand;
    auto                      known  = key_.begin();
    auto                      enters = key.begin();
    for (const std::uint64_t page : all)
    {
        const bool was_known  = known != key_.end() && *known == page,
                   is_entered = enters != key.end() && *enters == page;
        ranks.push_back(was_known ? rank_[index_of(key_, known)] : rank[index_of(key, enters)]);
        sand.push_back(is_entered ? std::uint8_t{1} : sand_[index_of(key_, known)]);
        known += was_known;
        enters += is_entered;
    }
    key_  = std::move(all);
    rank_ = std::move(ranks);
    sand_ = std::move(sand);
    share();
}

/// Copies what kernels need to the backend.
template<class Exec>
void PageMap<Exec>::share()
{
    std::vector<std::uint64_t> keys;
    PageRanks                  ranks;
    for (std::size_t page = 0; page < key_.size(); ++page)
    {
        if (sand_[page] == 0) { continue; }
        keys.push_back(key_[page]);
        ranks.push_back(rank_[page]);
    }
    device_key_.assign(keys);
    device_rank_.assign(ranks);
    ++changes_;
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
