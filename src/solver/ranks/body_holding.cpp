#include "solver/ranks/body_holding.hpp"

#include <algorithm>
#include <functional>

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

/// Whether these are holders of a body that `owner` shares: ascending, and it is among them.
bool can_hold(const std::vector<std::int32_t>& holders, std::int32_t owner, std::int32_t ranks)
{
    const bool ascends = std::adjacent_find(holders.begin(), holders.end(), std::greater_equal<>()) == holders.end();
    return holders.size() > 1 && ascends && holders.front() >= 0 && holders.back() < ranks &&
           std::binary_search(holders.begin(), holders.end(), owner);
}

} // namespace

std::vector<std::int32_t> words_of(const std::vector<BodyHolding>& holdings)
{
    std::vector<std::int32_t> words;
    for (const BodyHolding& body : holdings) { write_words(words, body); }
    return words;
}

std::optional<std::vector<BodyHolding>> read_holdings(const std::vector<std::int32_t>& words, std::int32_t owner,
                                                      std::int32_t ranks, std::size_t bodies)
{
    std::vector<BodyHolding> holdings;
    for (auto word = words.begin(); word != words.end();)
    {
        const auto left = words.end() - word;
        if (left < 3 || word[2] < 0 || word[2] > left - 3) { return std::nullopt; }
        const auto         first = word + 3, last = first + word[2];
        const BodyHolding  read{word[0], word[1], {first, last}};
        const std::int32_t least = holdings.empty() ? 0 : holdings.back().body + 1;
        const bool         known = read.body >= least && static_cast<std::size_t>(read.body) < bodies;
        if (!known || read.owner != owner || !can_hold(read.holders, owner, ranks)) { return std::nullopt; }
        holdings.push_back(read);
        word = last;
    }
    return holdings;
}

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
