#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/communicator.hpp"
#include "decomp/exchange.hpp"

// Decisions about who owns and who holds a body, and their exchange between ranks.
namespace tread::solver
{

/// Owner and holders of a body.
struct BodyHolding
{
    std::int32_t                  body;
    std::int32_t                  owner;
    std::span<const std::int32_t> holders; ///< ascending; the owner among them
};

/// A list of holdings, as words of a message or a file: body, owner, number of holders and holders of each.
class BodyHoldings
{
public:
    class Iterator
    {
    public:
        explicit Iterator(const std::int32_t* word)
            : word_(word)
        {
        }

        BodyHolding operator*() const { return {word_[0], word_[1], {word_ + 3, static_cast<std::size_t>(word_[2])}}; }
        Iterator&   operator++()
        {
            word_ += 3 + word_[2];
            return *this;
        }
        bool operator!=(const Iterator& other) const { return word_ != other.word_; }

    private:
        const std::int32_t* word_;
    };

    BodyHoldings() = default;

    /// `words`: of whole holdings.
    explicit BodyHoldings(std::vector<std::int32_t> words)
        : words_(std::move(words))
    {
    }

    void add(const BodyHolding& holding);
    bool empty() const { return words_.empty(); }

    Iterator begin() const { return Iterator(words_.data()); }
    Iterator end() const { return Iterator(words_.data() + words_.size()); }

    const std::vector<std::int32_t>& words() const { return words_; }

private:
    std::vector<std::int32_t> words_;
};

/// Looks holdings up, in ascending order of bodies.
class HoldingLookup
{
public:
    /// `held`: ascending; outlives this. A body that it does not list is `alone`'s.
    HoldingLookup(const BodyHoldings& held, std::int32_t alone)
        : next_(held.begin())
        , end_(held.end())
        , alone_(alone)
    {
    }

    bool lists(std::int32_t body)
    {
        while (next_ != end_ && (*next_).body < body) { ++next_; }
        return next_ != end_ && (*next_).body == body;
    }

    BodyHolding of(std::int32_t body) { return lists(body) ? *next_ : BodyHolding{body, alone_, {&alone_, 1}}; }

private:
    BodyHoldings::Iterator next_, end_;
    std::int32_t           alone_;
};

/// Whether a rank is one of these holders.
bool holds(const BodyHolding& body, std::int32_t rank);

/// One list of bodies, or of rows, per rank.
using RankLists = std::vector<std::vector<std::int32_t>>;

/// Changes of all ranks that concern this one: it held a body, or holds it from now on.
struct HoldingChanges
{
    BodyHoldings all;      ///< ascending
    RankLists    arriving; ///< by rank: bodies that this rank has not held, whose state it sends
    RankLists    leaving;  ///< by rank: likewise, of those that this rank decided about
};

/// Reads words that may come from anywhere; empty where they are none of BodyHoldings, ascending, for `bodies` bodies
/// that `owner`, one of `ranks` ranks, shares with others.
std::optional<BodyHoldings> read_holdings(const std::vector<std::int32_t>& words, std::int32_t owner,
                                          std::int32_t ranks, std::size_t bodies);

/// Sends what this rank has decided, ascending, about bodies that it owned, to who holds them and who did, and returns
/// what concerns this rank. `held`: bodies that it has shared until now, ascending. Collective.
HoldingChanges exchange_changes(const Communicator& communicator, const BodyHoldings& decided,
                                const BodyHoldings& held);

/// Bodies that `rank` shares after these changes, ascending. `held`: those before, ascending.
BodyHoldings changed(const BodyHoldings& held, const BodyHoldings& changes, std::int32_t rank);

/// Sends the holdings of bodies that this rank owns and shares to the other holders, and returns all that it holds,
/// ascending. Collective.
BodyHoldings exchange_holdings(const Communicator& communicator, const BodyHoldings& owned);

/// Routes of lists, in ascending order of ranks; none for an empty list.
std::vector<decomp::Route> routes_of(const RankLists& lists);

/// Concatenates lists in rank order.
std::vector<std::int32_t> joined(const RankLists& lists);

} // namespace tread::solver
