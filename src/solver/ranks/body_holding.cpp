#include "solver/ranks/body_holding.hpp"

#include <algorithm>

#include "decomp/messages.hpp"

namespace tread::solver
{
namespace
{

/// Writes a body's part of a message: body, owner, number of holders, holders.
void write_words(std::vector<std::int32_t>& words, const BodyHolding& body)
{
    words.insert(words.end(), {body.body, body.owner, static_cast<std::int32_t>(body.holders.size())});
    words.insert(words.end(), body.holders.begin(), body.holders.end());
}

} // namespace

ExchangedHoldings exchange_holdings(const Communicator& communicator, const std::vector<BodyHolding>& decided)
{
    const auto        ranks = static_cast<std::size_t>(communicator.size());
    RankLists         words(ranks);
    ExchangedHoldings found{{}, RankLists(ranks)};
    for (const BodyHolding& body : decided)
    {
        for (const std::int32_t holder : body.holders)
        {
            if (holder == communicator.rank()) { found.held.push_back(body); }
            else { write_words(words[static_cast<std::size_t>(holder)], body); }
        }
    }
    const RankLists received = decomp::exchange_values(communicator, words);
    for (std::size_t r = 0; r < received.size(); ++r)
    {
        for (auto word = received[r].begin(); word != received[r].end();)
        {
            const auto holders = word + 3, end = holders + word[2];
            found.held.push_back({word[0], word[1], {holders, end}});
            found.arriving[r].push_back(word[0]);
            word = end;
        }
    }
    std::sort(found.held.begin(), found.held.end(),
              [](const BodyHolding& a, const BodyHolding& b) { return a.body < b.body; });
    return found;
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
