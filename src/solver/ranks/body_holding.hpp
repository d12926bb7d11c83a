#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/communicator.hpp"
#include "decomp/exchange.hpp"

// Decisions about who owns and who holds a body, and their exchange between ranks.
namespace tread::solver
{

/// Owner and holders of a body that is not held by this rank alone.
struct BodyHolding
{
    std::int32_t              body;
    std::int32_t              owner;
    std::vector<std::int32_t> holders; ///< ascending; the owner among them
};

/// One list of bodies, or of rows, per rank.
using RankLists = std::vector<std::vector<std::int32_t>>;

/// Result of the exchange of all ranks' decisions.
struct ExchangedHoldings
{
    std::vector<BodyHolding> held;     ///< bodies that this rank shares from now on, ascending
    RankLists                arriving; ///< by rank: bodies whose state it sends
};

/// Writes holdings as words of a message or a file: body, owner, number of holders and holders of each.
std::vector<std::int32_t> words_of(const std::vector<BodyHolding>& holdings);

/// Reads what words_of has written; empty where these words are none of its, for `bodies` bodies that `owner`, one of
/// `ranks` ranks, shares with others.
std::optional<std::vector<BodyHolding>> read_holdings(const std::vector<std::int32_t>& words, std::int32_t owner,
                                                      std::int32_t ranks, std::size_t bodies);

/// Sends the decisions of this rank to the holders, and returns those that concern this rank. Collective.
ExchangedHoldings exchange_holdings(const Communicator& communicator, const std::vector<BodyHolding>& decided);

/// Routes of lists, in ascending order of ranks; none for an empty list.
std::vector<decomp::Route> routes_of(const RankLists& lists);

/// Concatenates lists in rank order.
std::vector<std::int32_t> joined(const RankLists& lists);

} // namespace tread::solver
