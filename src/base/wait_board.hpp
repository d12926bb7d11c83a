#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "base/communicator.hpp"

namespace tread
{

/// How many collective calls each rank of a node has begun, in memory that they share: a rank that waits in one can say
/// who has not come to it, without a message. All ranks make the same collective calls in the same order.
class WaitBoard
{
public:
    /// Collective over `world`, whose waits count from now on. Where a node has no memory to share the board is empty.
    explicit WaitBoard(const Communicator& world);
    ~WaitBoard();
    WaitBoard(const WaitBoard&)            = delete;
    WaitBoard& operator=(const WaitBoard&) = delete;

    /// Ranks of this node, ascending, that have begun fewer collective calls than this one.
    std::vector<int> behind() const;

    /// Whether ranks of this node can be compared.
    bool is_empty() const { return counts_ == nullptr; }

private:
    using Count = std::atomic<std::int64_t>;
    static_assert(Count::is_always_lock_free);

    std::size_t bytes() const { return ranks_.size() * sizeof(Count); }
    bool        open(const std::string& name, int flags);

    const Communicator& world_;
    std::vector<int>    ranks_;            ///< of this node, ascending
    std::size_t         own_    = 0;       ///< place of this rank among them
    Count*              counts_ = nullptr; ///< [ranks_]
};

} // namespace tread
