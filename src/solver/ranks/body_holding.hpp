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

/// Owner and holders of a body that is not held by this rank alone.
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

    Iterator begin() const { return Iterator(words_.data()); }
    Iterator end() const { return Iterator(words_.data() + words_.size()); }

    const std::vector<std::int32_t>& words() const { return words_; }

private:
    std::vector<std::int32_t> words_;
};

/// One list of bodies, or of rows, per rank.
using RankLists = std::vector<std::vector<std::int32_t>>;

/// Result of the exchange of all ranks' decisions.
struct ExchangedHoldings
{
    BodyHoldings held;     ///< bodies that this rank shares from now on, ascending
    RankLists    arriving; ///< by rank: bodies whose state it sends
};

/// Reads words that may come from anywhere; empty where they are none of BodyHoldings, ascending, for `bodies` bodies
/// that `owner`, one of `ranks` ranks, shares with others.
std::optional<BodyHoldings> read_holdings(const std::vector<std::int32_t>& words, std::int32_t owner,
                                          std::int32_t ranks, std::size_t bodies);

/// Sends the decisions of this rank, ascending, to the holders, and returns those that concern this rank. Collective.
ExchangedHoldings exchange_holdings(const Communicator& communicator, const BodyHoldings& decided);

/// Routes of lists, in ascending order of ranks; none for an empty list.
std::vector<decomp::Route> routes_of(const RankLists& lists);

/// Concatenates lists in rank order.
std::vector<std::int32_t> joined(const RankLists& lists);

} // namespace tread::solver
