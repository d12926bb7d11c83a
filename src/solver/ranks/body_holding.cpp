#include "solver/ranks/body_holding.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <iterator>
#include <utility>

#include "decomp/messages.hpp"

namespace tread::solver
{
namespace
{

void write_words(std::vector<std::int32_t>& words, const BodyHolding& body)
{
    words.insert(words.end(), {body.body, body.owner, static_cast<std::int32_t>(body.holders.size())});
    words.insert(words.end(), body.holders.begin(), body.holders.end());
}

/// Whether these are holders of a body that `owner` shares: ascending, and it is among them.
bool can_hold(std::span<const std::int32_t> holders, std::int32_t owner, std::int32_t ranks)
{
    const bool ascends = std::adjacent_find(holders.begin(), holders.end(), std::greater_equal<>()) == holders.end();
    return holders.size() > 1 && ascends && holders.front() >= 0 && holders.back() < ranks &&
           std::binary_search(holders.begin(), holders.end(), owner);
}

/// Merges lists that ascend.
BodyHoldings merged(const std::vector<BodyHoldings>& lists)
{
    const auto               by_body = [](const BodyHolding& a, const BodyHolding& b) { return a.body < b.body; };
    std::vector<BodyHolding> all;
    for (const BodyHoldings& list : lists)
    {
        const auto before = static_cast<std::ptrdiff_t>(all.size());
        for (const BodyHolding& body : list) { all.push_back(body); }
        std::inplace_merge(all.begin(), all.begin() + before, all.end(), by_body);
    }
    BodyHoldings found;
    for (const BodyHolding& body : all) { found.add(body); }
    return found;
}

} // namespace

void BodyHoldings::add(const BodyHolding& holding) { write_words(words_, holding); }

std::optional<BodyHoldings> read_holdings(const std::vector<std::int32_t>& words, std::int32_t owner,
                                          std::int32_t ranks, std::size_t bodies)
{
    std::int32_t least = 0;
    for (auto word = words.begin(); word != words.end();)
    {
        const auto left = words.end() - word;
        if (left < 3 || word[2] < 0 || word[2] > left - 3) { return std::nullopt; }
        const std::span<const std::int32_t> holders(word + 3, static_cast<std::size_t>(word[2]));
        const bool                          known = word[0] >= least && static_cast<std::size_t>(word[0]) < bodies;
        if (!known || word[1] != owner || !can_hold(holders, owner, ranks)) { return std::nullopt; }
        least = word[0] + 1;
        word += 3 + word[2];
    }
    return BodyHoldings(words);
}

bool holds(const BodyHolding& body, std::int32_t rank)
{
    return std::binary_search(body.holders.begin(), body.holders.end(), rank);
}

HoldingChanges exchange_changes(const Communicator& communicator, const BodyHoldings& decided, const BodyHoldings& held)
{
    const std::int32_t        here = communicator.rank();
    RankLists                 words(static_cast<std::size_t>(communicator.size()));
    std::vector<std::int32_t> concerned;
    HoldingChanges            found;
    found.leaving.resize(words.size());
    HoldingLookup before(held, here);
    for (const BodyHolding& body : decided)
    {
        const BodyHolding last = before.of(body.body);
        concerned.clear();
        std::ranges::set_union(body.holders, last.holders, std::back_inserter(concerned));
        for (const std::int32_t rank : concerned)
        {
            if (rank == here) { continue; }
            write_words(words[static_cast<std::size_t>(rank)], body);
            if (!holds(last, rank)) { found.leaving[static_cast<std::size_t>(rank)].push_back(body.body); }
        }
    }
    std::vector<BodyHoldings> all{decided};
    for (std::vector<std::int32_t>& received : decomp::exchange_values(communicator, words))
    {
        all.emplace_back(std::move(received));
        found.arriving.emplace_back();
        HoldingLookup known(held, here);
        for (const BodyHolding& body : all.back())
        {
            if (holds(body, here) && !known.lists(body.body)) { found.arriving.back().push_back(body.body); }
        }
    }
    found.all = merged(all);
    return found;
}

BodyHoldings changed(const BodyHoldings& held, const BodyHoldings& changes, std::int32_t rank)
{
    HoldingLookup             change(changes, rank);
    std::vector<BodyHoldings> parts(2);
    for (const BodyHolding& body : held)
    {
        if (!change.lists(body.body)) { parts[0].add(body); }
    }
    for (const BodyHolding& body : changes)
    {
        if (body.holders.size() > 1 && holds(body, rank)) { parts[1].add(body); }
    }
    return merged(parts);
}

BodyHoldings exchange_holdings(const Communicator& communicator, const BodyHoldings& owned)
{
    RankLists words(static_cast<std::size_t>(communicator.size()));
    for (const BodyHolding& body : owned)
    {
        for (const std::int32_t holder : body.holders) { write_words(words[static_cast<std::size_t>(holder)], body); }
    }
    std::vector<BodyHoldings> all;
    for (std::vector<std::int32_t>& received : decomp::exchange_values(communicator, words))
    {
        all.emplace_back(std::move(received));
    }
    return merged(all);
}

std::vector<decomp::Route> routes_of(const RankLists& lists)
{
    std::vector<decomp::Route> routes;
    for (std::size_t r = 0; r < lists.size(); ++r)
    {
        if (!lists[r].empty()) { routes.push_back({static_cast<int>(r), static_cast<std::int64_t>(lists[r].size())}); }
    }
    return routes;
}

std::vector<std::int32_t> joined(const RankLists& lists)
{
    std::vector<std::int32_t> all;
    for (const auto& list : lists) { all.insert(all.end(), list.begin(), list.end()); }
    return all;
}

} // namespace tread::solver
