#pragma once

#include <cstdint>
#include <vector>

#include "decomp/rows.hpp"
#include "decomp/transport.hpp"

namespace tread::decomp
{

/// Number of rows sent to a rank, or received from one.
struct Route
{
    int          rank;
    std::int64_t rows;
};

/// Sends rows of arrays to other ranks, repeatedly: plan once, then call begin() and finish() as often as needed. All
/// ranks make the same plans, and ranks that exchange rows make the same calls; a rank with an empty plan may skip
/// begin() and finish(). A plan fixes row numbers, ranks and counts, but not the arrays.
template<class Exec>
class Exchange
{
public:
    /// Collective. `name`: of the buffers, for the counters.
    Exchange(Transport<Exec>& transport, const char* name);

    /// Uses another stream of the transport's device: `exec` owns the arrays, packs and unpacks.
    Exchange(Transport<Exec>& transport, const Exec& exec, const char* name);

    /// Plans from rows_to[r], the rows for rank r in their order of arrival; none for this rank. Collective.
    void plan(const std::vector<std::vector<std::int32_t>>& rows_to);

    /// Plans without communication, if both sides know what to expect; not collective. `rows`: those for the first rank
    /// of `to`, then for the second, and so on; ranks ascend. The return path of an exchange `there` has routes
    /// there.from() and there.to().
    void plan(const std::vector<std::int32_t>& rows, std::vector<Route> to, std::vector<Route> from);

    /// Routes in ascending order of ranks.
    const std::vector<Route>& to() const { return to_; }
    const std::vector<Route>& from() const { return from_; }
    std::int64_t              sent() const { return rows_.size(); }
    std::int64_t              received() const { return received_; }

    /// Packs the rows and starts sending them. Kernels launched after it returns may change the arrays.
    void begin(const Columns& columns);

    /// Unpacks what arrived into rows first, first + 1, ... of the columns: by rank, ascending, each rank's rows in
    /// their order. Columns must have the widths of those of begin().
    void finish(const Columns& columns, std::int64_t first);

    /// Unpacks the k-th arriving row into row rows[k]; no row may occur twice.
    void finish(const Columns& columns, const Array<Exec, std::int32_t>& rows);

    /// Alternative to finish() for columns that are one array of rows: returns the rows as they arrived, valid until
    /// begin().
    const std::byte* finish();

private:
    void finish(const Columns& columns, const std::int32_t* index, std::int64_t first);

    Transport<Exec>*          transport_;
    Exec                      exec_;
    Messages<Exec>            messages_;
    Array<Exec, std::int32_t> rows_;
    std::vector<Route>        to_;
    std::vector<Route>        from_;
    MessageRanges             out_;
    MessageRanges             in_;
    std::int64_t              received_ = 0;
    const std::uint32_t*      arriving_ = nullptr;
};

} // namespace tread::decomp
