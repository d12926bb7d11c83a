#pragma once

#include <cstdint>
#include <vector>

#include "decomp/rows.hpp"
#include "decomp/transport.hpp"

namespace tread::decomp
{

/// So many rows for a rank, or from one.
struct Route
{
    int          rank;
    std::int64_t rows;
};

/// Rows of arrays that go to other ranks, time and again: planned once, then begin() and finish() as often as needed.
/// Every rank makes the same plans, and then the same calls as those that it has rows for or from; one whose plan is
/// empty may leave begin() and finish() out. What the plan does not change needs no new plan: row numbers, ranks and
/// counts, not the arrays.
template<class Exec>
class Exchange
{
public:
    /// Collective. `name` is the buffers' for the counters.
    Exchange(Transport<Exec>& transport, const char* name);

    /// The same on another lane of the transport's device: `exec` has the arrays, packs and unpacks.
    Exchange(Transport<Exec>& transport, const Exec& exec, const char* name);

    /// Collective. rows_to[r]: the rows for rank r, in the order in which they are to arrive; none for the own rank.
    void plan(const std::vector<std::vector<std::int32_t>>& rows_to);

    /// As before where both sides know already what comes; not collective. `rows`: first those for the first rank of
    /// `to`, which ascend, and so on. The way back of an exchange `there` has routes there.from() and there.to().
    void plan(const std::vector<std::int32_t>& rows, std::vector<Route> to, std::vector<Route> from);

    /// Ranks ascend.
    const std::vector<Route>& to() const { return to_; }
    const std::vector<Route>& from() const { return from_; }
    std::int64_t              sent() const { return rows_.size(); }
    std::int64_t              received() const { return received_; }

    /// Packs the rows and starts to send them. The arrays may change once it has returned, as far as kernels go that
    /// are launched after it.
    void begin(const Columns& columns);

    /// Rows of the lowest rank first, each rank's in its order, become rows first, first + 1, ... of the columns, which
    /// must be of the same widths as those of begin().
    void finish(const Columns& columns, std::int64_t first);

    /// What arrives k-th becomes row rows[k]; no row twice.
    void finish(const Columns& columns, const Array<Exec, std::int32_t>& rows);

    /// Instead of finish(), where the columns are one array of rows: these rows as they have arrived, until begin().
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
